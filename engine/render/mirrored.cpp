#include "render/mirrored.hpp"

#include "bvh/tlas.hpp"
#include "scene/material_facts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace catoptric::render {

namespace {

/// Planes; a point p is inside a plane if dot(xyz, p - eye) + w >= 0.
using ClipPlanes = std::vector<dvec4>;
using Polygon = std::vector<dvec3>; ///< convex, relative to the eye

/// An eye nearer than this to a mirror's plane, in scene units, sees the mirror edge-on. The value
/// is a few roundings of a coordinate near 1.
constexpr double kEdgeOnMirrorHeight = 1e-7;

/// Returns the part of a polygon in front of the plane (Sutherland and Hodgman 1974).
Polygon clip_polygon(const Polygon& polygon, const dvec4& plane) {
    Polygon left;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double of_a = dot(dvec3(plane), a) + plane.w, of_b = dot(dvec3(plane), b) + plane.w;
        if (of_a >= 0) left.push_back(a);
        if ((of_a >= 0) != (of_b >= 0)) left.push_back(a + (b - a) * (of_a / (of_a - of_b)));
    }
    return left;
}

/// Returns the position of a point in the view's picture, each coordinate from -1 to 1.
dvec2 project_to_picture(const shared::View& view, const dvec3& v) {
    const double w = view.parallel != 0 ? 1 : dot(dvec3(view.forward), v);
    return dvec2(dot(dvec3(view.right), v), dot(dvec3(view.down), v)) / w;
}

/// A rectangle of the picture, -1 to 1.
struct PictureRectangle {
    dvec2 low{-1}, high{1};
};

PictureRectangle to_rectangle(const graph::PixelRectangle& area, uvec2 size) {
    const dvec2 low(area.x, area.y), extent(area.width, area.height);
    return {low / dvec2(size) * 2.0 - 1.0, (low + extent) / dvec2(size) * 2.0 - 1.0};
}

/// Returns the side planes and the near plane of a part of the view.
ClipPlanes side_planes(const shared::View& view, const PictureRectangle& part) {
    const dvec3 right(view.right), down(view.down), forward(view.forward);
    if (view.parallel != 0)
        return {{right, -part.low.x},
                {-right, part.high.x},
                {down, -part.low.y},
                {-down, part.high.y},
                {forward, 0}};
    return {{forward, -static_cast<double>(view.near)},
            {right - part.low.x * forward, 0},
            {part.high.x * forward - right, 0},
            {down - part.low.y * forward, 0},
            {part.high.y * forward - down, 0}};
}

/// Returns a coordinate of the picture, -1 to 1 at its edges, moved by an angle. `scale`: the
/// coordinate of the direction at 45 degrees. Returns an infinity if the direction does not point
/// forward.
double turn_coordinate(double at, double scale, double angle) {
    const double turned = std::atan(at / scale) + angle;
    if (std::abs(turned) < std::numbers::pi / 2) return scale * std::tan(turned);
    return std::copysign(std::numeric_limits<double>::infinity(), angle);
}

/// Returns the pixels that a visible polygon may cover, those up to the angle beside them, and one
/// more on each side. An angle has no meaning in a parallel view, which gets all pixels of
/// `within`.
graph::PixelRectangle covered_pixels(const Polygon& polygon, const shared::View& view, uvec2 size,
                                     const graph::PixelRectangle& within, double blur_angle) {
    if (blur_angle > 0 && view.parallel != 0) return within;
    dvec2 low(1), high(-1);
    for (const dvec3& v : polygon) {
        const dvec2 at = project_to_picture(view, v);
        low = min(low, at), high = max(high, at);
    }
    if (blur_angle > 0) {
        const dvec2 scale(length(dvec3(view.right)), length(dvec3(view.down)));
        for (int i = 0; i < 2; ++i) {
            low[i] = turn_coordinate(low[i], scale[i], -blur_angle);
            high[i] = turn_coordinate(high[i], scale[i], blur_angle);
        }
    }
    const auto pixel = [&](const dvec2& at, double more) {
        return (at * .5 + .5) * dvec2(size) + more;
    };
    const dvec2 first = max(floor(pixel(low, -1)), dvec2(within.x, within.y)),
                end = min(ceil(pixel(high, 1)),
                          dvec2(within.x + within.width, within.y + within.height));
    if (!(first.x < end.x && first.y < end.y)) return {};
    const uvec2 corner(first), extent(end - first);
    return {corner.x, corner.y, extent.x, extent.y};
}

dvec3 mirror_vector(const dvec3& direction, const dvec3& normal) {
    return direction - 2 * dot(direction, normal) * normal;
}

/// Returns the view of the eye mirrored in the plane. `height`: of the original eye above the
/// plane, along the normal.
MirroredView make_view_behind(const MirroredView& from, const scene::FlatFace& plane, double height,
                              const Bounds<float>& everything) {
    MirroredView made;
    made.eye = from.eye - 2 * height * plane.normal;
    const auto turned = [&](const vec3& axis) {
        return vec3(mirror_vector(dvec3(axis), plane.normal));
    };
    shared::View& view = made.view = from.view;
    view.eye = vec3(made.eye);
    view.eye_low = bvh::float_rounding_error(made.eye);
    view.right = turned(from.view.right), view.down = turned(from.view.down),
    view.forward = turned(from.view.forward);
    // A ray that leaves through the mirror has a length of at least the eye's distance from the
    // mirror, so the near plane does not change. A parallel view extends to the end of the scene.
    if (view.parallel != 0) {
        const dvec3 forward(view.forward), middle(everything.centre()),
            half(dvec3(everything.extent()) * .5);
        const double end = dot(forward, middle - made.eye) + dot(abs(forward), half);
        view.near = static_cast<float>(1 / std::max(1.001 * end, 1e-3));
    }
    view.clip = vec4(vec3(height > 0 ? plane.normal : -plane.normal),
                     static_cast<float>(-std::abs(height)));
    return made;
}

/// Returns the view in the mirror as `from` shows it; nothing if `from` does not show the mirror.
std::optional<MirroredView> make_mirrored_view(const MirroredView& from,
                                               const MirrorPlane& mirror_plane, uvec2 size,
                                               const Bounds<float>& everything) {
    const scene::FlatFace& mirror = mirror_plane.flat;
    const double height = dot(from.eye - mirror.point, mirror.normal);
    if (std::abs(height) < kEdgeOnMirrorHeight || (mirror.is_one_sided && height < 0)) return {};
    Polygon polygon;
    for (const dvec3& corner : mirror.corners) polygon.push_back(corner - from.eye);
    // A mirror that touches or lies in the plane of the mirror in which it is seen does not count
    // as visible.
    const dvec4 clip(from.view.clip);
    if (clip != dvec4(0) && std::ranges::all_of(polygon, [&](const dvec3& corner) {
            return dot(dvec3(clip), corner) + clip.w <= kEdgeOnMirrorHeight;
        }))
        return {};
    ClipPlanes planes = side_planes(from.view, to_rectangle(from.area, size));
    if (clip != dvec4(0)) planes.push_back(clip);
    for (const dvec4& plane : planes) polygon = clip_polygon(polygon, plane);
    if (polygon.empty()) return {};
    const graph::PixelRectangle area = covered_pixels(polygon, from.view, size, from.area,
                                                      mirror_plane.blur_angle);
    if (area.width == 0) return {};
    MirroredView made = make_view_behind(from, mirror, height, everything);
    made.area = area;
    return made;
}

/// The inputs that all views share.
struct MirroredViewInputs {
    const std::vector<std::optional<MirrorPlane>>& planes;
    uvec2 size;
    const Bounds<float>& everything;
};

/// Adds the views of mirrors that `from` shows, up to `left` mirrors deep. `within`: index of
/// `from`; empty for the camera. Returns false if there are too many views.
bool add_mirrored_views(std::vector<MirroredView>& views, const MirroredView& from,
                        std::optional<std::size_t> within, const MirroredViewInputs& mirrors,
                        int left) {
    for (std::uint32_t mirror = 0; mirror < mirrors.planes.size(); ++mirror) {
        if (!mirrors.planes[mirror] || (within && from.plane_index == mirror)) continue;
        const MirrorPlane& plane = *mirrors.planes[mirror];
        const int deep = within ? left : std::min(left, plane.bounces);
        if (deep == 0) continue;
        std::optional<MirroredView> made = make_mirrored_view(from, plane, mirrors.size,
                                                              mirrors.everything);
        if (!made) continue;
        if (views.size() == kMaxMirroredViews) return false;
        made->plane_index = mirror, made->within = within;
        views.push_back(*made);
        if (!add_mirrored_views(views, *made, views.size() - 1, mirrors, deep - 1)) return false;
    }
    return true;
}

} // namespace

std::vector<MirroredView>
find_mirrored_views(const MirroredViewEye& camera,
                    const std::vector<std::optional<MirrorPlane>>& mirrors, uvec2 size, int& most) {
    const MirroredView first{
        .view = camera.view, .eye = camera.place, .area = {0, 0, size.x, size.y}};
    std::vector<MirroredView> views;
    while (!add_mirrored_views(views, first, {}, {mirrors, size, camera.everything}, most)) {
        views.clear();
        --most;
    }
    return views;
}

bool may_show(const MirroredView& view, uvec2 size, const Bounds<float>& box) {
    ClipPlanes planes = side_planes(view.view, to_rectangle(view.area, size));
    planes.emplace_back(view.view.clip);
    const dvec3 middle = dvec3(box.centre()) - view.eye, half(dvec3(box.extent()) * .5);
    return std::ranges::all_of(planes, [&](const dvec4& plane) {
        const double reach = dot(dvec3(plane), middle) + dot(abs(dvec3(plane)), half) + plane.w;
        return reach >= -kEdgeOnMirrorHeight * length(dvec3(plane));
    });
}

} // namespace catoptric::render
