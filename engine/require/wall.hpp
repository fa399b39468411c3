#pragma once

#include "scene/scene.hpp"

#include <array>
#include <cstddef>
#include <vector>

/// Walls: convex quadrilaterals, with tests that say which boxes they hide from a viewer.
namespace catoptric::require {

/// Four corners in a plane, in order around. From the front, the order is counterclockwise.
using QuadCorners = std::array<dvec3, 4>;

std::array<dvec3, 8> box_corners(const Bounds<double>& box);

/// Returns the least and the largest product of the axis with points of the box.
std::array<double, 2> project_box(const dvec3& axis, const Bounds<double>& box);

/// Returns the pairs of triangles that form convex quadrilaterals, in the mesh's own space. The two
/// triangles share an edge, lie in one plane (within kCoplanarTolerance of their extent) and have
/// one orientation, and every corner is convex. Each triangle is in at most one pair. Returns none
/// for a mesh with more than kMaxWallTriangles. O(triangles^2).
std::vector<QuadCorners> find_convex_quads(const scene::Mesh& mesh);
inline constexpr double kCoplanarTolerance = 1e-9;
inline constexpr std::size_t kMaxWallTriangles = 64;

/// An opaque quadrilateral in world space.
struct Wall {
    QuadCorners corners;
    std::size_t object = 0;
    bool front_only = false; ///< whether the wall hides nothing from viewers behind it
    bool seen_by_camera = true;
    dvec3 normal{0}; ///< unit, towards the front
    std::array<dvec3, 4>
        inward{}; ///< unit, in the plane, normal of the edge that starts at corner i
    double area = 0;

    double height(const dvec3& place) const { return dot(normal, place - corners[0]); }
    double distance_inside(std::size_t edge, const dvec3& place) const {
        return dot(inward[edge], place - corners[edge]);
    }
};
/// A wall of zero area hides nothing.
Wall make_wall(const QuadCorners& corners, std::size_t object);

/// Returns whether each segment from a point of `viewer` to a point of `target` crosses the wall.
/// Crossings must lie at least `margin` inside the wall's edges. The ends must lie on different
/// sides of the wall's plane, at least `margin` away. `viewer` may be a single point. About .4 us
/// if the wall hides the target, .01 us if not.
///
/// Proof: let boxes V and T lie strictly on different sides. The plane cuts hull(V, T) in the hull
/// of the points where segments between corners of V and T cross it. The reason is that each point
/// of a segment is a mean of corners of V and T, and projection along the segment keeps means. If
/// these (at most 64) crossings lie in the wall, which is convex, all crossings do. Let h be the
/// height over the plane and e the distance inside an edge's line, both linear. The crossing of v
/// and t has e = (e(v) |h(t)| + e(t) |h(v)|) / (|h(v)| + |h(t)|).
bool hides(const Wall& wall, const Bounds<double>& viewer, const Bounds<double>& target,
           double margin);

/// Returns whether the wall hides the box `target` from an orthographic camera. All rays to
/// `target` run along the unit `direction`, from the plane through `eye` across it. A corner's
/// crossing is linear in the corner, so eight segments suffice.
bool hides_from_orthographic(const Wall& wall, const dvec3& eye, const dvec3& direction,
                             const Bounds<double>& target, double margin);

} // namespace catoptric::require
