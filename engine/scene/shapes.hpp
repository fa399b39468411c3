#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// Two triangles (a b c) (a c d) with the flat normal normalize(cross(b-a, c-a)).
Mesh quad(std::string name, dvec3 a, dvec3 b, dvec3 c, dvec3 d);

/// The wall of the box [lo, hi] in direction +X -X +Y -Y +Z -Z (as the faces of a cube map), facing
/// in.
Mesh wall(int face, dvec3 lo, dvec3 hi);

/// Unit ball from a tetrahedron subdivided `levels` times, midpoints normalised at each level:
/// 4^(levels+1) triangles, 2*4^levels + 2 shared vertices, smooth normals. Level 5 is the
/// contract's ball: 4096 triangles, 2050 vertices.
Mesh ball(std::string name, int levels);

} // namespace catoptric::scene
