#include "render/views.hpp"

#include "bvh/two_level.hpp"
#include "core/error.hpp"
#include "core/shader_math.hpp"
#include "scene/core.hpp"

#include <array>
#include <cmath>

namespace catoptric::render {

namespace {

// Depth is a float with reversed range: its relative precision does not depend on the near plane,
// so near only has to be above 0 and below everything. 2^-24: the rounding of a coordinate about 1.
constexpr float kSmallestNear = 0x1p-24f;

} // namespace

shared::View camera_view(const scene::Camera& camera, const Space& space, uvec2 size, float gap) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const dvec3 down = glm::cross(forward, right);
    const double tangent = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    const double aspect = static_cast<double>(size.x) / static_cast<double>(size.y);
    // A thing at distance `gap` in the corner of the picture lies this far along the axis.
    const double along = 1 / std::sqrt(1 + tangent * tangent * (1 + aspect * aspect));
    shared::View view{};
    const dvec3 eye = space.place(camera.eye);
    view.eye = vec3(eye);
    view.eye_low = bvh::low_part(eye);
    view.right = vec3(right / (tangent * aspect));
    view.down = vec3(down / tangent);
    view.forward = vec3(forward);
    view.near = std::max(kSmallestNear, 0.5f * gap * static_cast<float>(along));
    // Written so that a NaN is refused too.
    check(length(view.eye) <= scene::kFarthestReach && length(view.forward) > .5f &&
              length(view.right) > 0 && length(view.down) > 0,
          Failure::usage, "camera '", camera.name, "': wanted an eye within ",
          scene::kFarthestReach,
          " sizes of the scene, a target away from it and an up that is not along, found eye ",
          camera.eye.x, ",", camera.eye.y, ",", camera.eye.z);
    return view;
}

std::vector<shared::View> cube_views(vec3 eye, float gap) {
    return turned_cube_views(eye, vec3(0), gap);
}

std::vector<shared::View> turned_cube_views(vec3 eye, vec3 forward, float gap) {
    glm::mat3 world_from_cube(1);
    if (forward != vec3(0)) {
        const vec3 size = abs(forward);
        const vec3 other = size.x <= size.y && size.x <= size.z ? vec3(1, 0, 0)
                           : size.y <= size.z                   ? vec3(0, 1, 0)
                                                                : vec3(0, 0, 1);
        const vec3 x = normalize(cross(other, forward));
        world_from_cube = glm::mat3(x, cross(forward, x), forward);
    }
    std::vector<shared::View> views;
    for (int face = 0; face < 6; ++face) {
        shared::View view{};
        view.eye = eye;
        view.right = world_from_cube * f32::cube_direction(face, vec3(1, 0, 0));
        view.down = world_from_cube * f32::cube_direction(face, vec3(0, 1, 0));
        view.forward = world_from_cube * f32::cube_direction(face, vec3(0, 0, 1));
        // The nearest thing may lie in a corner, 1 / sqrt(3) of its distance along the axis.
        view.near = std::max(kSmallestNear, 0.5f * gap);
        views.push_back(view);
    }
    return views;
}

bool may_meet(const shared::View& view, const Bounds<float>& box) {
    const std::array<vec3, 5> inward{view.forward, view.forward + view.right,
                                     view.forward - view.right, view.forward + view.down,
                                     view.forward - view.down};
    for (const vec3& plane : inward) {
        const vec3 furthest(plane.x > 0 ? box.hi.x : box.lo.x, plane.y > 0 ? box.hi.y : box.lo.y,
                            plane.z > 0 ? box.hi.z : box.lo.z);
        if (dot(plane, furthest - view.eye) < 0) return false;
    }
    return true;
}

} // namespace catoptric::render
