#include "require/wall.hpp"

#include <algorithm>
#include <optional>

namespace catoptric::require {

namespace {

/// Returns whether all corners turn the same way and the four lie in one plane.
bool is_convex(const QuadCorners& quad) {
    const dvec3 normal = cross(quad[2] - quad[0], quad[3] - quad[1]);
    const double size = length(normal);
    if (!(size > 0)) return false;
    for (std::size_t i = 0; i < 4; ++i) {
        const dvec3 along = quad[(i + 1) % 4] - quad[i], on = quad[(i + 2) % 4] - quad[i];
        if (!(dot(cross(along, on), normal) > kCoplanarTolerance * size * size)) return false;
        if (std::abs(dot(along, normal)) > kCoplanarTolerance * size * length(along)) return false;
    }
    return true;
}

/// Returns the convex quadrilateral that the two triangles form, or none.
std::optional<QuadCorners> join_to_quad(const scene::Mesh& mesh, const uvec3& one,
                                        const uvec3& other) {
    const auto at = [&](const uvec3& triangle, int i) { return mesh.positions[triangle[i % 3]]; };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            // Neighbours with the same orientation run along their shared edge in opposite
            // directions.
            if (at(one, i) != at(other, j + 1) || at(one, i + 1) != at(other, j)) continue;
            const QuadCorners quad{at(one, i), at(other, j + 2), at(one, i + 1), at(one, i + 2)};
            if (is_convex(quad)) return quad;
        }
    return std::nullopt;
}

/// The corners of a box, or its only point if the box is a point.
struct BoxCorners {
    std::array<dvec3, 8> at;
    std::size_t count = 8;
    explicit BoxCorners(const Bounds<double>& box) : at(box_corners(box)) {
        if (box.lo == box.hi) count = 1;
    }
};

struct WallDistances {
    double height;                ///< distance from the plane, positive
    std::array<double, 4> inside; ///< distance inside each edge
};
WallDistances wall_distances(const Wall& wall, const dvec3& place) {
    WallDistances side{std::abs(wall.height(place)), {}};
    for (std::size_t edge = 0; edge < 4; ++edge)
        side.inside[edge] = wall.distance_inside(edge, place);
    return side;
}

} // namespace

std::array<dvec3, 8> box_corners(const Bounds<double>& box) {
    std::array<dvec3, 8> corners;
    for (unsigned i = 0; i < 8; ++i)
        corners[i] = {i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                      i & 4 ? box.hi.z : box.lo.z};
    return corners;
}

std::array<double, 2> project_box(const dvec3& axis, const Bounds<double>& box) {
    const double middle = dot(axis, box.centre()), reach = dot(abs(axis), box.extent()) / 2;
    return {middle - reach, middle + reach};
}

std::vector<QuadCorners> find_convex_quads(const scene::Mesh& mesh) {
    std::vector<QuadCorners> quads;
    const std::size_t count = mesh.triangles.size();
    if (count > kMaxWallTriangles) return quads;
    std::vector<bool> is_used(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count && !is_used[i]; ++j) {
            if (is_used[j]) continue;
            const std::optional<QuadCorners> quad = join_to_quad(mesh, mesh.triangles[i],
                                                                 mesh.triangles[j]);
            if (!quad) continue;
            quads.push_back(*quad);
            is_used[i] = is_used[j] = true;
        }
    return quads;
}

Wall make_wall(const QuadCorners& corners, std::size_t object) {
    Wall wall{.corners = corners, .object = object};
    const dvec3 twice = cross(corners[2] - corners[0], corners[3] - corners[1]);
    wall.area = length(twice) / 2;
    if (!(wall.area > 0)) return wall;
    wall.normal = twice / (2 * wall.area);
    for (std::size_t i = 0; i < 4; ++i)
        wall.inward[i] = normalize(cross(wall.normal, corners[(i + 1) % 4] - corners[i]));
    return wall;
}

bool hides(const Wall& wall, const Bounds<double>& viewer, const Bounds<double>& target,
           double margin) {
    const auto [viewer_low, viewer_high] = project_box(wall.normal, viewer);
    const auto [target_low, target_high] = project_box(wall.normal, target);
    const double plane = dot(wall.normal, wall.corners[0]), above = plane + margin,
                 below = plane - margin;
    const bool from_front = viewer_low > above && target_high < below;
    const bool from_behind = viewer_high < below && target_low > above && !wall.front_only;
    if (!(from_front || from_behind)) return false;
    const BoxCorners from(viewer), to(target);
    std::array<WallDistances, 8> there;
    for (std::size_t j = 0; j < to.count; ++j) there[j] = wall_distances(wall, to.at[j]);
    for (std::size_t i = 0; i < from.count; ++i) {
        const WallDistances here = wall_distances(wall, from.at[i]);
        for (std::size_t j = 0; j < to.count; ++j)
            for (std::size_t edge = 0; edge < 4; ++edge)
                if (!(here.inside[edge] * there[j].height + there[j].inside[edge] * here.height >=
                      margin * (here.height + there[j].height)))
                    return false;
    }
    return true;
}

bool hides_from_orthographic(const Wall& wall, const dvec3& eye, const dvec3& direction,
                             const Bounds<double>& target, double margin) {
    const double slant = dot(wall.normal, direction);
    if (wall.front_only && slant >= 0) return false;
    for (const dvec3& corner : box_corners(target)) {
        const double depth = dot(corner - eye, direction), height = wall.height(corner);
        const double back = height / slant; // distance back to the wall, against the direction
        if (!(back > margin && depth - back > margin)) return false;
        for (std::size_t edge = 0; edge < 4; ++edge)
            if (!(wall.distance_inside(edge, corner - back * direction) >= margin)) return false;
    }
    return true;
}

} // namespace catoptric::require
