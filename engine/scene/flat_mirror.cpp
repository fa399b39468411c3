#include "scene/flat_mirror.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

namespace catoptric::scene {

namespace {

/// Of the largest triangle, unit; zero where none has an area.
dvec3 largest_normal(const Mesh& mesh, const dmat4& world_from_object) {
    dvec3 largest(0);
    for (const uvec3& triangle : mesh.triangles) {
        const dvec3 a = transform_point(world_from_object, mesh.positions[triangle.x]),
                    b = transform_point(world_from_object, mesh.positions[triangle.y]),
                    c = transform_point(world_from_object, mesh.positions[triangle.z]);
        const dvec3 normal = cross(b - a, c - a);
        if (dot(normal, normal) > dot(largest, largest)) largest = normal;
    }
    const double size = length(largest);
    return size > 0 ? largest / size : dvec3(0);
}

/// Angle between two lines along unit vectors; the sine, where it is small.
double angle_between(const dvec3& a, const dvec3& b) { return length(cross(a, b)); }

/// Corners of the convex hull of points of the plane (Andrew 1979).
std::vector<dvec3> hull(std::vector<dvec3> points, const dvec3& normal) {
    const dvec3 size = abs(normal), other = size.x <= size.y && size.x <= size.z ? dvec3(1, 0, 0)
                                            : size.y <= size.z                   ? dvec3(0, 1, 0)
                                                                                 : dvec3(0, 0, 1);
    const dvec3 right = normalize(cross(other, normal)), up = cross(normal, right);
    const auto place = [&](const dvec3& p) { return std::pair(dot(p, right), dot(p, up)); };
    std::ranges::sort(points, {}, place);
    std::vector<dvec3> corners;
    const auto add_half = [&](const auto& half) {
        const std::size_t first = corners.size();
        for (const dvec3& p : half) {
            const auto turns_right = [&] {
                const dvec3 &a = corners[corners.size() - 2], &b = corners.back();
                return dot(cross(b - a, p - b), normal) <= 0;
            };
            while (corners.size() >= first + 2 && turns_right()) corners.pop_back();
            corners.push_back(p);
        }
        corners.pop_back(); // the other half begins there
    };
    add_half(points);
    add_half(std::views::reverse(points));
    return corners;
}

} // namespace

std::optional<Flat> flat(const Mesh& mesh, const dmat4& world_from_object) {
    // Most curved things are told by the first normals, before all triangles are looked at.
    const dmat3 turns = normal_matrix(world_from_object);
    const auto normal_of = [&](std::size_t vertex) {
        return world_normal(turns, dvec3(mesh.normals[vertex]));
    };
    for (const uvec3& triangle : mesh.triangles)
        if (angle_between(normal_of(triangle.x), normal_of(mesh.triangles.front().x)) >
            2 * kFarFromFlat)
            return {};
    Flat found;
    found.normal = largest_normal(mesh, world_from_object);
    if (found.normal == dvec3(0)) return {};
    std::vector<dvec3> points;
    for (const uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner) {
            points.push_back(transform_point(world_from_object, mesh.positions[triangle[corner]]));
            found.off = std::max(found.off,
                                 angle_between(normal_of(triangle[corner]), found.normal));
        }
    found.point = points.front();
    found.corners = hull(points, found.normal);
    double size = 0;
    for (const dvec3& corner : found.corners)
        size = std::max(size, distance(corner, found.corners.front()));
    for (const dvec3& p : points)
        found.off = std::max(found.off, std::abs(dot(p - found.point, found.normal)) / size);
    // Written so that a NaN is refused too.
    return found.off <= kFarFromFlat ? std::optional(found) : std::nullopt;
}

double flat_tolerance(const Camera& camera, uvec2 size) {
    const double half = camera.orthographic_height > 0
                            ? 1
                            : std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    return std::atan(2 * half / size.y) / 16;
}

} // namespace catoptric::scene
