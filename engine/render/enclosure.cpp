#include "render/enclosure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace catoptric::render {

namespace {

// Tolerance for a sum of solid angles, far above its rounding error.
constexpr double kSolidAngleTolerance = 1e-3;

using PositionKey = std::array<double, 3>;

PositionKey position_key(const dvec3& p) { return {p.x, p.y, p.z}; }

/// Returns whether each edge is traversed equally often in both directions. Edges are compared by
/// position, not by vertex index. `at(k)`: corner k, three corners a triangle.
template <typename At>
bool is_closed_surface(std::size_t corners, At&& at) {
    std::map<std::pair<PositionKey, PositionKey>, int> runs;
    for (std::size_t k = 0; k < corners; k += 3)
        for (std::size_t j = 0; j < 3; ++j) {
            const PositionKey a = position_key(at(k + j)), b = position_key(at(k + (j + 1) % 3));
            if (a < b) ++runs[{a, b}];
            if (b < a) --runs[{b, a}];
        }
    return std::ranges::all_of(runs, [](const auto& run) { return run.second == 0; });
}

/// Returns the solid angle of the triangle as seen from the origin, signed by its winding (Van
/// Oosterom and Strackee 1983); 0 in the triangle's plane.
double solid_angle(dvec3 a, dvec3 b, dvec3 c) {
    const double volume = dot(a, cross(b, c)), x = length(a), y = length(b), z = length(c);
    if (volume == 0) return 0;
    return 2 * std::atan2(volume, x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y);
}

} // namespace

bool encloses(const FrameGeometry& geometry, const DrawRange& range, const dvec3& place) {
    const vec3 in_scene(place);
    if (!(all(lessThanEqual(range.bounds.lo, in_scene)) &&
          all(lessThanEqual(in_scene, range.bounds.hi))))
        return false;
    const vec3 point = range.own ? vec3(range.own->to_object(place)) : in_scene;
    double seen = 0;
    for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count; k += 3) {
        const auto corner = [&](std::uint32_t j) {
            return dvec3(geometry.vertices[geometry.indices[k + j]].position) - dvec3(point);
        };
        seen += solid_angle(corner(0), corner(1), corner(2));
    }
    // The sum of solid angles is 4 pi for a point inside the object, half of it on a face, and a
    // fraction of it on an edge or a corner. For a point outside, the sum is 0.
    return std::abs(seen) > kSolidAngleTolerance &&
           is_closed_surface(range.index_count, [&](std::size_t k) {
               return dvec3(geometry.vertices[geometry.indices[range.first_index + k]].position);
           });
}

bool is_closed_shell(const scene::Mesh& mesh) {
    Bounds<double> box;
    for (const dvec3& position : mesh.positions) box.add(position);
    const dvec3 middle = box.empty() ? dvec3(0) : box.centre();
    const auto arm = [&](std::uint32_t vertex) { return mesh.positions[vertex] - middle; };
    const bool faces_out = std::ranges::all_of(mesh.triangles, [&](const uvec3& t) {
        return dot(arm(t.x), cross(arm(t.y), arm(t.z))) > 0;
    });
    return faces_out && is_closed_surface(3 * mesh.triangles.size(), [&](std::size_t k) {
               return mesh.positions[mesh.triangles[k / 3][static_cast<int>(k % 3)]];
           });
}

} // namespace catoptric::render
