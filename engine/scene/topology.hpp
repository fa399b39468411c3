#pragma once

#include "core/math.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

/// Topology of a mesh: the vertices and edges at which its triangles meet.
namespace catoptric::scene {

/// Vertex numbers of a triangle's corners.
using TriangleCorners = std::array<std::size_t, 3>;

inline bool has_distinct_corners(const TriangleCorners& t) {
    return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

/// Returns for each vertex the first vertex at the same place. Two places are the same if no
/// coordinate differs by more than 2^-21 of the largest coordinate, four roundings of a float. The
/// tolerance is needed because files compute the two ends of a seam apart. O(n).
std::vector<std::size_t> weld_vertices(std::span<const dvec3> positions);

struct TriangleEdge {
    std::size_t low, high; ///< ends of the edge
    std::size_t triangle;
    std::size_t tip; ///< third corner of the triangle
};

/// Returns the sides of all triangles, ordered by edge, then by triangle. A triangle with two equal
/// corners is skipped. O(n log n).
std::vector<TriangleEdge> triangle_edges(std::span<const TriangleCorners> triangles);

/// Returns whether every edge of the mesh belongs to two triangles, where vertices at the same
/// place are one. False without triangles. O(n log n).
bool is_closed_surface(std::span<const dvec3> positions, std::span<const uvec3> triangles);

/// Returns how often the closed surface winds around a point: +-1 inside, 0 outside and +-1/2 on
/// it. From the signed solid angles of the triangles (Van Oosterom and Strackee, "The Solid Angle
/// of a Plane Triangle", 1983). O(n).
double winding_number(std::span<const dvec3> positions, std::span<const uvec3> triangles,
                      const dvec3& point);

/// Calls `visit(std::span<const TriangleEdge>)` for each edge with the sides that meet there. A
/// surface is closed if every edge has two sides.
template <typename Visit>
void for_each_edge(const std::vector<TriangleEdge>& sides, Visit&& visit) {
    for (std::size_t first = 0, end = 0; first < sides.size(); first = end) {
        while (end < sides.size() && sides[end].low == sides[first].low &&
               sides[end].high == sides[first].high)
            ++end;
        visit(std::span(sides).subspan(first, end - first));
    }
}

} // namespace catoptric::scene
