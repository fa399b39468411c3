#include "require/content_hashes.hpp"

#include "core/content_hash.hpp"
#include "require/frustum.hpp"
#include "require/sight.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

Bounds<double> seen_from(const dvec3& centre, const Bounds<double>& box) {
    return {box.lo - centre, box.hi - centre};
}

bool may_be_small(const World& world, const WorldObject& thing) {
    Bounds<double> around = world.still();
    around.add(thing.box);
    const auto largest = [](const dvec3& v) { return std::max({v.x, v.y, v.z}); };
    return largest(thing.tight.extent()) < kSmall * largest(around.extent());
}

} // namespace

void ContentHashes::follow(const World& world, std::uint32_t shadow_edge) {
    const bool is_anew = layout_ != world.layouts();
    if (!world.has_changed() && !is_anew && shadow_edge_ == shadow_edge) return;
    if (is_anew) mirrors_.assign(world.mirrors().size(), {});
    ++changes_;
    layout_ = world.layouts(), epoch_ = world.epoch(), shadow_edge_ = shadow_edge;
    ContentHash all(epoch_);
    for (const std::size_t mover : world.movers()) all.add(world.things()[mover].content_hash);
    all_ = all.value();
    const std::size_t movers = world.movers().size(), mirrors = world.mirrors().size();
    is_much_ = movers * world.lights().size() * world.things().size() > kMostPairs ||
               movers * mirrors > kMostPairs;
    landings_.clear();
    if (is_much_) return;
    find_landings(world, shadow_edge, landings_);
    is_much_ = landings_.size() * mirrors > kMostLandings;
}

const ContentHashes::Faces6& ContentHashes::of_faces(const World& world, std::size_t mirror) {
    Faces6& faces = mirrors_[mirror];
    const std::size_t object = world.mirrors()[mirror];
    const WorldObject& own = world.things()[object];
    if (faces.made_at == changes_) return faces;
    faces.made_at = changes_;
    faces.pieces = nullptr;
    if (is_much_ || own.has_moved || own.box.empty())
        faces.content_hashes.fill(ContentHash(all_).add(mirror).value());
    else
        add_up(world, faces, mirror);
    return faces;
}

void ContentHashes::add_up(const World& world, Faces6& faces, std::size_t mirror) const {
    const std::size_t object = world.mirrors()[mirror];
    const WorldObject& own = world.things()[object];
    const dvec3 centre = own.tight.centre();
    // Hashes are summed, because the order of the movers has no meaning.
    std::array<std::uint64_t, 6> sums{};
    const auto pieces = std::make_shared<Pieces>();
    bool are_many = false;
    const auto add = [&](Faces which, std::uint64_t content_hash, auto&& part_of) {
        for (int face = 0; face < 6; ++face) {
            if ((which >> face & 1) == 0) continue;
            sums[face] += content_hash;
            are_many = are_many || pieces->faces[face].size() == kMostPieces;
            if (!are_many) pieces->faces[face].push_back({content_hash, part_of(face)});
        }
    };
    for (const std::size_t mover : world.movers()) {
        const WorldObject& thing = world.things()[mover];
        if (mover == object || thing.box.empty()) continue;
        const Bounds<double> box = seen_from(centre, thing.box);
        if (may_be_small(world, thing))
            add(kAllFaces, thing.content_hash, [](int) { return FacePart(); });
        else
            add(faces_with(box) & faces_with(thing.middle - centre, thing.radius),
                thing.content_hash, [&](int face) { return part_with(face, box); });
    }
    for (const Landing& landing : landings_) {
        if (landing.receiver == object) continue;
        const Bounds<double> box = seen_from(centre, landing.box),
                             from = seen_from(centre, landing.shade.from),
                             to = seen_from(centre, landing.shade.to);
        add(faces_with(box) & faces_with(from, to),
            ContentHash(world.things()[landing.caster].content_hash).add(landing.receiver).value(),
            [&](int face) { return common(part_with(face, box), part_with(face, from, to)); });
    }
    for (std::size_t face = 0; face < 6; ++face) {
        faces.settings[face] =
            ContentHash(epoch_).add(own.content_hash).add(mirror).add(face).value();
        faces.content_hashes[face] = ContentHash(faces.settings[face]).add(sums[face]).value();
    }
    if (are_many) return;
    pieces->sort();
    faces.pieces = pieces;
}

std::vector<Caster> ContentHashes::casters(const World& world) const {
    std::vector<Caster> casters;
    for (const std::size_t mover : world.movers())
        if (const WorldObject& thing = world.things()[mover]; thing.casts_shadow)
            casters.push_back({static_cast<std::uint32_t>(mover), thing.content_hash});
    return casters;
}

} // namespace catoptric::require
