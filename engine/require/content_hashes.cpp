#include "require/content_hashes.hpp"

#include "core/content_hash.hpp"
#include "require/frustum.hpp"
#include "require/sight.hpp"

#include <algorithm>

namespace catoptric::require {

namespace {

Bounds<double> bounds_relative_to_centre(const dvec3& centre, const Bounds<double>& box) {
    return {box.lo - centre, box.hi - centre};
}

bool may_object_have_object_space(const VisibilityScene& world, const VisibilityObject& thing) {
    Bounds<double> around = world.bounds_of_static_objects();
    around.add(thing.box);
    const auto largest = [](const dvec3& v) { return std::max({v.x, v.y, v.z}); };
    return largest(thing.tight.extent()) <
           kSmallObjectSizeToDistanceRatio * largest(around.extent());
}

} // namespace

void ContentHashes::move_to_instant(const VisibilityScene& world, std::uint32_t shadow_edge,
                                    bool has_soft_shadows) {
    const bool is_new_layout = layout_ != world.layout_count();
    if (!world.has_world_changed() && !is_new_layout && shadow_edge_ == shadow_edge &&
        has_soft_shadows_ == has_soft_shadows)
        return;
    if (is_new_layout) mirrors_.assign(world.list_mirror_objects().size(), {});
    ++changes_;
    layout_ = world.layout_count(), static_hash_ = world.static_content_hash(),
    shadow_edge_ = shadow_edge, has_soft_shadows_ = has_soft_shadows;
    ContentHash all(static_hash_);
    for (const std::size_t mover : world.list_moving_objects())
        all.add(world.list_objects()[mover].content_hash);
    all_ = all.sum();
    const std::size_t movers = world.list_moving_objects().size(),
                      mirrors = world.list_mirror_objects().size();
    is_much_ = movers * world.list_point_lights().size() * world.list_objects().size() >
                   kMaxVisibilityPairs ||
               movers * mirrors > kMaxVisibilityPairs;
    landings_.clear();
    if (is_much_) return;
    find_shadow_receivers(world, shadow_edge, has_soft_shadows, landings_);
    is_much_ = landings_.size() * mirrors > kMaxShadowReceiverTests;
}

const ContentHashes::CaptureFaceHashes&
ContentHashes::content_hashes_of_mirror_faces(const VisibilityScene& world, std::size_t mirror) {
    CaptureFaceHashes& faces = mirrors_[mirror];
    const std::size_t object = world.list_mirror_objects()[mirror];
    const VisibilityObject& own = world.list_objects()[object];
    if (faces.made_at == changes_) return faces;
    faces.made_at = changes_;
    faces.pieces = nullptr;
    if (is_much_ || own.has_moved || own.box.empty())
        faces.content_hashes.fill(ContentHash(all_).add(mirror).sum());
    else
        combine_capture_face_hashes(world, faces, mirror);
    return faces;
}

void ContentHashes::combine_capture_face_hashes(const VisibilityScene& world,
                                                CaptureFaceHashes& faces,
                                                std::size_t mirror) const {
    const std::size_t object = world.list_mirror_objects()[mirror];
    const VisibilityObject& own = world.list_objects()[object];
    const dvec3 centre = own.tight.centre();
    // Hashes of movers are added, so that the result does not depend on the order of the movers.
    std::array<std::uint64_t, 6> sums{};
    const auto pieces = std::make_shared<MovingObjectFaceParts>();
    bool are_many = false;
    const auto add = [&](CubeFaceBits which, std::uint64_t content_hash, auto&& part_of) {
        for (int face = 0; face < 6; ++face) {
            if ((which >> face & 1) == 0) continue;
            sums[face] += content_hash;
            are_many = are_many || pieces->faces[face].size() == kMaxMovingPartsPerFace;
            if (!are_many) pieces->faces[face].push_back({content_hash, part_of(face)});
        }
    };
    for (const std::size_t mover : world.list_moving_objects()) {
        const VisibilityObject& thing = world.list_objects()[mover];
        if (mover == object || thing.box.empty()) continue;
        const Bounds<double> box = bounds_relative_to_centre(centre, thing.box);
        if (may_object_have_object_space(world, thing))
            add(kAllCubeFaceBits, thing.content_hash, [](int) { return CubeFacePart(); });
        else
            add(cube_faces_that_may_show_box(box) &
                    cube_faces_that_may_show_ball(thing.middle - centre, thing.radius),
                thing.content_hash, [&](int face) { return face_part_containing(face, box); });
    }
    for (const ShadowReceiver& landing : landings_) {
        if (landing.receiver == object) continue;
        const Bounds<double> box = bounds_relative_to_centre(centre, landing.box),
                             from = bounds_relative_to_centre(centre, landing.shade.from),
                             to = bounds_relative_to_centre(centre, landing.shade.to);
        add(cube_faces_that_may_show_box(box) & cube_faces_that_may_show_hull(from, to),
            ContentHash(world.list_objects()[landing.caster].content_hash)
                .add(landing.receiver)
                .sum(),
            [&](int face) {
                return intersect_face_parts(face_part_containing(face, box),
                                            face_part_containing(face, from, to));
            });
    }
    for (std::size_t face = 0; face < 6; ++face) {
        faces.settings[face] =
            ContentHash(static_hash_).add(own.content_hash).add(mirror).add(face).sum();
        faces.content_hashes[face] = ContentHash(faces.settings[face]).add(sums[face]).sum();
    }
    if (are_many) return;
    pieces->sort_moving_face_pieces();
    faces.pieces = pieces;
}

std::vector<ShadowCaster> ContentHashes::list_shadow_casters(const VisibilityScene& world) const {
    std::vector<ShadowCaster> casters;
    for (const std::size_t mover : world.list_moving_objects())
        if (const VisibilityObject& thing = world.list_objects()[mover]; thing.casts_shadow)
            casters.push_back({static_cast<std::uint32_t>(mover), thing.content_hash});
    return casters;
}

} // namespace catoptric::require
