#include "scene/flat_mirror.hpp"

#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>

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

/// A rectangle around points of the plane, along the way from its first to its farthest point.
std::array<dvec3, 4> rectangle(const std::vector<dvec3>& points, const dvec3& normal) {
    const dvec3& first = points.front();
    const dvec3 far = *std::ranges::max_element(
        points, {}, [&](const dvec3& p) { return dot(p - first, p - first); });
    dvec3 along = far - first;
    along = normalize(along - dot(along, normal) * normal);
    const dvec3 across = cross(normal, along);
    dvec2 low(0), high(0);
    for (const dvec3& p : points) {
        const dvec2 at(dot(p - first, along), dot(p - first, across));
        low = min(low, at), high = max(high, at);
    }
    const auto corner = [&](double u, double v) { return first + u * along + v * across; };
    return {corner(low.x, low.y), corner(high.x, low.y), corner(high.x, high.y),
            corner(low.x, high.y)};
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
    found.corners = rectangle(points, found.normal);
    const double size = distance(found.corners[0], found.corners[2]);
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
