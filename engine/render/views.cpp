#include "render/views.hpp"

#include "bvh/tlas.hpp"
#include "core/error.hpp"
#include "core/shader_math.hpp"
#include "scene/scene_core.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::render {

namespace {

// Depth is a float with reversed range, so its relative precision does not depend on the near
// plane. Near only has to be above 0 and below everything. 2^-24 is the rounding of a coordinate
// near 1.
constexpr float kMinNearPlane = 0x1p-24f;

/// Margin around the contents of a parallel view, as a fraction of their size. It far exceeds
/// roundings.
constexpr double kDepthRangeMargin = 1e-3;
/// If the window over everything is at most this many times larger than the window over the core,
/// the large window serves as both.
constexpr double kMaxShadowWindowFactor = 1.5;

/// Returns the axes of a cube whose face +Z looks along `forward`, as columns.
glm::mat3 make_turned_axes(vec3 forward) {
    const vec3 size = abs(forward);
    const vec3 other = size.x <= size.y && size.x <= size.z ? vec3(1, 0, 0)
                       : size.y <= size.z                   ? vec3(0, 1, 0)
                                                            : vec3(0, 0, 1);
    const vec3 x = normalize(cross(other, forward));
    return glm::mat3(x, cross(forward, x), forward);
}

/// The least and the largest product of an axis with the points of a box.
struct DepthRange {
    double low = 0, high = 0;
};
DepthRange project_box(const dvec3& axis, const Bounds<float>& box) {
    if (box.empty()) return {};
    const dvec3 middle(box.centre()), half(dvec3(box.extent()) / 2.0);
    const double at = dot(axis, middle), reach = dot(abs(axis), half);
    return {at - reach, at + reach};
}

/// Returns where all geometry begins and ends along an axis, with a margin.
DepthRange depth_range(const dvec3& forward, const Bounds<float>& everything) {
    const auto [low, high] = project_box(forward, everything);
    const double room = kDepthRangeMargin * std::max(high - low, 1.0);
    return {low - room, high + room};
}

/// Makes the view parallel. It reaches from a plane at depth.low, to which the eye moves, to a
/// plane at depth.high.
void make_parallel_view(shared::View& view, dvec3& eye, const dvec3& forward,
                        const DepthRange& depth) {
    eye += forward * (depth.low - dot(forward, eye));
    view.near = static_cast<float>(1 / std::max(depth.high - depth.low, kDepthRangeMargin));
    view.parallel = 1;
}

} // namespace

Bounds<float> geometry_bounds(const FrameGeometry& geometry) {
    Bounds<float> everything;
    for (const DrawRange& range : geometry.ranges) everything.add(range.bounds);
    return everything;
}

shared::View make_camera_view(const scene::Camera& camera, const SceneUnits& space, uvec2 size,
                              float gap, const Bounds<float>& everything) {
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    const dvec3 right = glm::normalize(glm::cross(forward, camera.up));
    const dvec3 down = glm::cross(forward, right);
    const double tangent = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    const double aspect = static_cast<double>(size.x) / static_cast<double>(size.y);
    // A surface that is `gap` away from the eye in a corner of the picture has this depth along the
    // view's axis.
    const double along = 1 / std::sqrt(1 + tangent * tangent * (1 + aspect * aspect));
    shared::View view{};
    dvec3 eye = space.to_scene(camera.eye);
    view.right = vec3(right / (tangent * aspect));
    view.down = vec3(down / tangent);
    view.forward = vec3(forward);
    view.near = std::max(kMinNearPlane, 0.5f * gap * static_cast<float>(along));
    if (camera.orthographic_height > 0) {
        const double half = camera.orthographic_height * space.scale / 2;
        view.right = vec3(right / (half * aspect));
        view.down = vec3(down / half);
        const DepthRange depth = depth_range(forward, everything);
        make_parallel_view(view, eye, forward,
                           {std::max(depth.low, dot(forward, eye)), depth.high});
    }
    view.eye = vec3(eye);
    view.eye_low = bvh::float_rounding_error(eye);
    // The comparison is written so that NaN fails, too.
    check(
        length(view.eye) <= scene::kMaxSceneRadius && length(view.forward) > .5f &&
            length(view.right) > 0 && length(view.down) > 0,
        Failure::usage, "camera '", camera.name, "': wanted an eye within ", scene::kMaxSceneRadius,
        " sizes of the scene, a target away from it and an up that is not parallel to the view, found eye ",
        camera.eye.x, ",", camera.eye.y, ",", camera.eye.z);
    return view;
}

namespace {

/// Returns the largest power of two that is not above a positive number.
float power_of_two_below(float number) { return std::ldexp(1.0f, std::ilogb(number)); }

} // namespace

std::vector<shared::View> make_cube_views(vec3 eye, float gap) {
    return make_turned_views(eye, vec3(0), gap);
}

std::vector<shared::View> make_turned_views(vec3 eye, vec3 forward, float gap) {
    return make_turned_views(eye, forward == vec3(0) ? glm::mat3(1) : make_turned_axes(forward),
                             gap);
}

std::vector<shared::View> make_turned_views(vec3 eye, const glm::mat3& world_from_cube, float gap) {
    std::vector<shared::View> views;
    for (int face = 0; face < 6; ++face) {
        shared::View view{};
        view.eye = eye;
        view.right = world_from_cube * f32::cube_direction(face, vec3(1, 0, 0));
        view.down = world_from_cube * f32::cube_direction(face, vec3(0, 1, 0));
        view.forward = world_from_cube * f32::cube_direction(face, vec3(0, 0, 1));
        // The nearest surface may lie in a corner, at 1 / sqrt(3) of its distance along the axis. A
        // power of two seldom changes as something approaches, and a change alters only the
        // exponent of depths.
        view.near = std::max(kMinNearPlane, power_of_two_below(0.5f * gap));
        views.push_back(view);
    }
    return views;
}

std::array<shared::View, 2> make_directional_views(vec3 forward, const Bounds<float>& core,
                                                   const Bounds<float>& everything) {
    const glm::mat3 axes = make_turned_axes(forward);
    const dvec3 right(axes[0]), down(-axes[1]); // as in face +Z
    const Bounds<float>& middle = core.empty() ? everything : core;
    dvec3 eye = middle.empty() ? dvec3(0) : dvec3(middle.centre());
    const auto half_of = [&](const dvec3& axis, const Bounds<float>& box) {
        const auto [low, high] = project_box(axis, box);
        const double at = dot(axis, eye);
        return std::max({high - at, at - low, 1e-6}) * (1 + kDepthRangeMargin);
    };
    const double core_width = half_of(right, middle), core_height = half_of(down, middle),
                 width = half_of(right, everything), height = half_of(down, everything);
    shared::View view{};
    view.forward = forward;
    make_parallel_view(view, eye, dvec3(forward), depth_range(dvec3(forward), everything));
    view.eye = vec3(eye);
    view.right = vec3(right / width), view.down = vec3(down / height);
    std::array<shared::View, 2> views{view, view};
    if (std::max(width, height) > kMaxShadowWindowFactor * std::max(core_width, core_height))
        views[0].right = vec3(right / core_width), views[0].down = vec3(down / core_height);
    return views;
}

namespace {

/// Returns the inward normals, of any length, of the planes that bound a perspective view. All
/// planes pass through the eye.
std::array<vec3, 5> inward_planes(const shared::View& view) {
    return {view.forward, view.forward + view.right, view.forward - view.right,
            view.forward + view.down, view.forward - view.down};
}

/// Returns whether the box may lie inside a parallel view: between its sides and in front of its
/// eye.
bool may_parallel_show(const shared::View& view, const Bounds<float>& box) {
    const auto furthest = [&](const vec3& plane) {
        const vec3 corner(plane.x > 0 ? box.hi.x : box.lo.x, plane.y > 0 ? box.hi.y : box.lo.y,
                          plane.z > 0 ? box.hi.z : box.lo.z);
        return dot(plane, corner - view.eye);
    };
    return furthest(view.forward) >= 0 && furthest(view.right) >= -1 &&
           furthest(-view.right) >= -1 && furthest(view.down) >= -1 && furthest(-view.down) >= -1;
}

} // namespace

bool may_show(const shared::View& view, const Bounds<float>& box) {
    if (view.parallel != 0) return may_parallel_show(view, box);
    for (const vec3& plane : inward_planes(view)) {
        const vec3 furthest(plane.x > 0 ? box.hi.x : box.lo.x, plane.y > 0 ? box.hi.y : box.lo.y,
                            plane.z > 0 ? box.hi.z : box.lo.z);
        if (dot(plane, furthest - view.eye) < 0) return false;
    }
    return true;
}

bool may_show(const shared::View& view, const DrawRange& range) {
    // Fraction of the distance, for the roundings of positions and planes.
    constexpr float kViewPlaneRoundingError = 0x1p-20f;
    if (!may_show(view, range.bounds)) return false;
    if (view.parallel != 0) return true;
    const vec3 towards = range.bounds.centre() - view.eye;
    const float radius = range.radius + kViewPlaneRoundingError * (range.radius + length(towards));
    return std::ranges::all_of(inward_planes(view), [&](const vec3& plane) {
        return dot(plane, towards) >= -radius * length(plane);
    });
}

} // namespace catoptric::render
