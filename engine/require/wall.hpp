#pragma once

#include "scene/scene.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// Convex quadrilaterals, and what they hide.
namespace catoptric::require {

/// Four corners in a plane, in order around; to the side from which they run counterclockwise is
/// the front.
using Quad = std::array<dvec3, 4>;

/// The eight corners of a box.
std::array<dvec3, 8> corners_of(const Bounds<double>& box);

/// Products of an axis with the places of a box: the least and the largest.
std::array<double, 2> along(const dvec3& axis, const Bounds<double>& box);

/// Pairs of the mesh's triangles that are such quadrilaterals, in the mesh's own space: an edge in
/// common, one plane (within kFlat of their extent), one orientation, every corner convex. No
/// triangle is in two. None of a mesh with more than kMostTriangles. O(triangles^2).
std::vector<Quad> quads_of(const scene::Mesh& mesh);
inline constexpr double kFlat = 1e-9;
inline constexpr std::size_t kMostTriangles = 64;

/// A quadrilateral in the world that nothing can be seen through.
struct Wall {
    Quad corners;
    std::size_t object = 0;
    bool front_only = false; ///< not there for who looks from behind
    bool seen_by_camera = true;
    dvec3 normal{0};               ///< unit, to the front
    std::array<dvec3, 4> inward{}; ///< unit, in the plane, of the edge from corner i
    double area = 0;

    double height(const dvec3& place) const { return dot(normal, place - corners[0]); }
    double inside(std::size_t edge, const dvec3& place) const {
        return dot(inward[edge], place - corners[edge]);
    }
};
/// Without an area it hides nothing.
Wall wall_of(const Quad& corners, std::size_t object);

/// Whether each segment from a place of `viewer` to one of `target` crosses the wall at least
/// `margin` inside of its edges, its ends that far from the wall's plane on different sides.
///
/// Where V and T lie strictly on different sides, what the plane cuts of hull(V, T) is the hull of
/// where the segments between their corners cross it: a place of a segment is a mean of corners of
/// V and of T, and projecting along the segment keeps means. So if those (at most 64) crossings lie
/// in the wall, which is convex, all do. With h the heights over the plane and e the distance
/// inside an edge's line, both linear, the crossing of v and t has e = (e(v) |h(t)| + e(t) |h(v)|)
/// / (|h(v)| + |h(t)|). `viewer` may be a point. About .4 us where it hides, .01 where it does not.
bool hides(const Wall& wall, const Bounds<double>& viewer, const Bounds<double>& target,
           double margin);

/// The same where all who look at `target` look along the unit `direction` from the plane through
/// `eye` across it: a corner's crossing is linear in the corner, so eight segments do.
bool hides_along(const Wall& wall, const dvec3& eye, const dvec3& direction,
                 const Bounds<double>& target, double margin);

} // namespace catoptric::require
