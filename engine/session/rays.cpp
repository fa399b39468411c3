#include "session/rays.hpp"

#include "bvh/copies.hpp"

namespace catoptric::session {

bvh::Bvh build_bvh_without(const render::FrameGeometry& geometry, std::size_t left_out) {
    std::vector<bvh::Triangle> triangles;
    for (std::size_t object = 0; object < geometry.ranges.size(); ++object) {
        const render::DrawRange& range = geometry.ranges[object];
        if (object == left_out) continue;
        for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count;
             k += 3) {
            const auto corner = [&](std::uint32_t j) {
                return geometry.vertices[geometry.indices[k + j]].position;
            };
            triangles.push_back({corner(0), corner(1), corner(2),
                                 static_cast<std::uint32_t>(object),
                                 (range.seen_by_camera ? 0 : bvh::kHiddenFromCameraFlag) |
                                     (range.one_sided ? bvh::kOneSidedFlag : 0)});
        }
    }
    return bvh::build(triangles, geometry.core, bvh::CopyScope::across_objects);
}

f32::Ray make_camera_ray(const shared::View& view, uvec2 size, std::size_t pixel) {
    const vec2 place(static_cast<float>(pixel % size.x) + 0.5f,
                     static_cast<float>(pixel / size.x) + 0.5f);
    const vec2 ndc = place / vec2(size) * 2.0f - 1.0f;
    if (view.parallel != 0)
        return {view.eye + (ndc.x * view.right / dot(view.right, view.right) +
                            ndc.y * view.down / dot(view.down, view.down)),
                view.forward, 0};
    return {view.eye,
            normalize(view.forward + ndc.x * view.right / dot(view.right, view.right) +
                      ndc.y * view.down / dot(view.down, view.down)),
            0};
}

} // namespace catoptric::session
