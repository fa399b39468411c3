#include "require/content_hashes.hpp"

#include "core/content_hash.hpp"
#include "require/frustum.hpp"
#include "require/sight.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

Bounds<double> bounds_relative_to(const dvec3& centre, const Bounds<double>& box) {
    return {box.lo - centre, box.hi - centre};
}

bool may_look_small(const VisibilityWorld& world, const WorldObject& thing) {
    Bounds<double> around = world.static_bounds();
    around.add(thing.box);
    const auto largest = [](const dvec3& v) { return std::max({v.x, v.y, v.z}); };
    return largest(thing.tight.extent()) < kSmallObjectRatio * largest(around.extent());
}

} // namespace

void ContentHashes::move_to_instant(const VisibilityWorld& world, std::uint32_t shadow_edge) {
    const bool is_new_layout = layout_ != world.layout_count();
    if (!world.has_changed() && !is_new_layout && shadow_edge_ == shadow_edge) return;
    if (is_new_layout) mirrors_.assign(world.mirrors().size(), {});
    ++changes_;
    layout_ = world.layout_count(), epoch_ = world.epoch(), shadow_edge_ = shadow_edge;
    ContentHash all(epoch_);
    for (const std::size_t mover : world.movers()) all.add(world.objects()[mover].content_hash);
    all_ = all.hash_value();
    const std::size_t movers = world.movers().size(), mirrors = world.mirrors().size();
    is_much_ = movers * world.lights().size() * world.objects().size() > kMaxVisibilityPairs ||
               movers * mirrors > kMaxVisibilityPairs;
    landings_.clear();
    if (is_much_) return;
    find_shadow_receivers(world, shadow_edge, landings_);
    is_much_ = landings_.size() * mirrors > kMaxShadowLandingTests;
}

const ContentHashes::FaceHashes& ContentHashes::face_hashes_of_mirror(const VisibilityWorld& world,
                                                                      std::size_t mirror) {
    FaceHashes& faces = mirrors_[mirror];
    const std::size_t object = world.mirrors()[mirror];
    const WorldObject& own = world.objects()[object];
    if (faces.made_at == changes_) return faces;
    faces.made_at = changes_;
    faces.pieces = nullptr;
    if (is_much_ || own.has_moved || own.box.empty())
        faces.content_hashes.fill(ContentHash(all_).add(mirror).hash_value());
    else
        combine_face_hashes(world, faces, mirror);
    return faces;
}

void ContentHashes::combine_face_hashes(const VisibilityWorld& world, FaceHashes& faces,
                                        std::size_t mirror) const {
    const std::size_t object = world.mirrors()[mirror];
    const WorldObject& own = world.objects()[object];
    const dvec3 centre = own.tight.centre();
    // Hashes are summed, because the order of the movers has no meaning.
    std::array<std::uint64_t, 6> sums{};
    const auto pieces = std::make_shared<FacePieces>();
    bool are_many = false;
    const auto add = [&](FaceBits which, std::uint64_t content_hash, auto&& part_of) {
        for (int face = 0; face < 6; ++face) {
            if ((which >> face & 1) == 0) continue;
            sums[face] += content_hash;
            are_many = are_many || pieces->faces[face].size() == kMaxPiecesPerFace;
            if (!are_many) pieces->faces[face].push_back({content_hash, part_of(face)});
        }
    };
    for (const std::size_t mover : world.movers()) {
        const WorldObject& thing = world.objects()[mover];
        if (mover == object || thing.box.empty()) continue;
        const Bounds<double> box = bounds_relative_to(centre, thing.box);
        if (may_look_small(world, thing))
            add(kAllFaces, thing.content_hash, [](int) { return FacePart(); });
        else
            add(faces_that_may_show_box(box) &
                    faces_that_may_show_box(thing.middle - centre, thing.radius),
                thing.content_hash, [&](int face) { return face_part_containing(face, box); });
    }
    for (const ShadowReceiver& landing : landings_) {
        if (landing.receiver == object) continue;
        const Bounds<double> box = bounds_relative_to(centre, landing.box),
                             from = bounds_relative_to(centre, landing.shade.from),
                             to = bounds_relative_to(centre, landing.shade.to);
        add(faces_that_may_show_box(box) & faces_that_may_show_box(from, to),
            ContentHash(world.objects()[landing.caster].content_hash)
                .add(landing.receiver)
                .hash_value(),
            [&](int face) {
                return intersect_face_parts(face_part_containing(face, box),
                                            face_part_containing(face, from, to));
            });
    }
    for (std::size_t face = 0; face < 6; ++face) {
        faces.settings[face] =
            ContentHash(epoch_).add(own.content_hash).add(mirror).add(face).hash_value();
        faces.content_hashes[face] = ContentHash(faces.settings[face]).add(sums[face]).hash_value();
    }
    if (are_many) return;
    pieces->sort_pieces();
    faces.pieces = pieces;
}

std::vector<ShadowCaster> ContentHashes::list_shadow_casters(const VisibilityWorld& world) const {
    std::vector<ShadowCaster> casters;
    for (const std::size_t mover : world.movers())
        if (const WorldObject& thing = world.objects()[mover]; thing.casts_shadow)
            casters.push_back({static_cast<std::uint32_t>(mover), thing.content_hash});
    return casters;
}

} // namespace catoptric::require
