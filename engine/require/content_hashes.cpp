#include "require/content_hashes.hpp"

#include "core/content_hash.hpp"
#include "require/frustum.hpp"
#include "require/sight.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

Bounds<double> relative_to(const dvec3& centre, const Bounds<double>& box) {
    return {box.lo - centre, box.hi - centre};
}

bool may_have_object_space(const VisibilityScene& world, const VisibilityObject& thing) {
    Bounds<double> around = world.static_bounds();
    around.add(thing.box);
    const auto largest = [](const dvec3& v) { return std::max({v.x, v.y, v.z}); };
    return largest(thing.tight.extent()) < kSmallObjectRatio * largest(around.extent());
}

} // namespace

void ContentHashes::update(const VisibilityScene& world, std::uint32_t shadow_edge,
                           bool has_soft_shadows) {
    const bool is_new_layout = layout_ != world.layout_version();
    if (!world.has_changed() && !is_new_layout && shadow_edge_ == shadow_edge &&
        has_soft_shadows_ == has_soft_shadows)
        return;
    if (is_new_layout) mirrors_.assign(world.mirrors().size(), {});
    ++changes_;
    layout_ = world.layout_version(), static_hash_ = world.static_hash(),
    shadow_edge_ = shadow_edge, has_soft_shadows_ = has_soft_shadows;
    ContentHash all(static_hash_);
    for (const std::size_t mover : world.movers()) all.add(world.objects()[mover].content_hash);
    all_ = all.sum();
    const std::size_t movers = world.movers().size(), mirrors = world.mirrors().size();
    is_much_ = movers * world.lights().size() * world.objects().size() > kMaxVisibilityPairs ||
               movers * mirrors > kMaxVisibilityPairs;
    receivers_.clear();
    if (is_much_) return;
    find_shadow_receivers(world, shadow_edge, has_soft_shadows, receivers_);
    is_much_ = receivers_.size() * mirrors > kMaxShadowReceiverTests;
}

const ContentHashes::FaceHashes& ContentHashes::face_hashes(const VisibilityScene& world,
                                                            std::size_t mirror) {
    FaceHashes& faces = mirrors_[mirror];
    const std::size_t object = world.mirrors()[mirror];
    const VisibilityObject& own = world.objects()[object];
    if (faces.made_at == changes_) return faces;
    faces.made_at = changes_;
    faces.pieces = nullptr;
    if (is_much_ || own.has_moved || own.box.empty())
        faces.content_hashes.fill(ContentHash(all_).add(mirror).sum());
    else
        combine_hashes(world, faces, mirror);
    return faces;
}

void ContentHashes::combine_hashes(const VisibilityScene& world, FaceHashes& faces,
                                   std::size_t mirror) const {
    const std::size_t object = world.mirrors()[mirror];
    const VisibilityObject& own = world.objects()[object];
    const dvec3 centre = own.tight.centre();
    // Hashes of movers are added, so that the result does not depend on the order of the movers.
    std::array<std::uint64_t, 6> sums{};
    const auto pieces = std::make_shared<MovingParts>();
    bool are_many = false;
    const auto add = [&](FaceBits which, std::uint64_t content_hash, auto&& part_of) {
        for (int face = 0; face < 6; ++face) {
            if ((which >> face & 1) == 0) continue;
            sums[face] += content_hash;
            are_many = are_many || pieces->faces[face].size() == kMaxMovingParts;
            if (!are_many) pieces->faces[face].push_back({content_hash, part_of(face)});
        }
    };
    for (const std::size_t mover : world.movers()) {
        const VisibilityObject& thing = world.objects()[mover];
        if (mover == object || thing.box.empty()) continue;
        const Bounds<double> box = relative_to(centre, thing.box);
        if (may_have_object_space(world, thing))
            add(kAllFaces, thing.content_hash, [](int) { return FacePart(); });
        else
            add(faces_showing_box(box) & faces_showing_ball(thing.middle - centre, thing.radius),
                thing.content_hash, [&](int face) { return face_part_containing(face, box); });
    }
    for (const ShadowReceiver& part : receivers_) {
        if (part.receiver == object) continue;
        const Bounds<double> box = relative_to(centre, part.box),
                             from = relative_to(centre, part.shade.from),
                             to = relative_to(centre, part.shade.to);
        add(faces_showing_box(box) & faces_showing_hull(from, to),
            ContentHash(world.objects()[part.caster].content_hash).add(part.receiver).sum(),
            [&](int face) {
                return intersect(face_part_containing(face, box),
                                 face_part_containing(face, from, to));
            });
    }
    for (std::size_t face = 0; face < 6; ++face) {
        faces.still_hashes[face] =
            ContentHash(static_hash_).add(own.content_hash).add(mirror).add(face).sum();
        faces.content_hashes[face] = ContentHash(faces.still_hashes[face]).add(sums[face]).sum();
    }
    if (are_many) return;
    pieces->sort();
    faces.pieces = pieces;
}

std::vector<ShadowCaster> ContentHashes::shadow_casters(const VisibilityScene& world) const {
    std::vector<ShadowCaster> casters;
    for (const std::size_t mover : world.movers())
        if (const VisibilityObject& thing = world.objects()[mover]; thing.casts_shadow)
            casters.push_back({static_cast<std::uint32_t>(mover), thing.content_hash});
    return casters;
}

} // namespace catoptric::require
