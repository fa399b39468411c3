#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

namespace catoptric::scene {

/// Height of a part of a built-in scene above its support, in metres. If two surfaces lie in one
/// plane, chance decides which of them a picture shows.
inline constexpr double kStandingGap = .001;

/// Returns two triangles, (a b c) and (a c d), with the flat normal normalize(cross(b-a, c-a)).
CATOPTRIC_API Mesh quad(std::string name, dvec3 a, dvec3 b, dvec3 c, dvec3 d);

/// Returns the wall of the box [lo, hi] in direction `face`, facing in. The directions are +X -X +Y
/// -Y +Z -Z, as the faces of a cube map.
CATOPTRIC_API Mesh wall(int face, dvec3 lo, dvec3 hi);

/// Returns the box [lo, hi] seen from outside, with flat normals. Each side shows texture space
/// [0,1]^2.
CATOPTRIC_API Mesh box(std::string name, dvec3 lo, dvec3 hi);

/// Returns the surface of a profile of (radius, height) that turns around the y axis, with `around`
/// vertices to a turn. The outside lies to the right of a profile that goes upwards. Normals are
/// those of the curve through the points. A point that is given twice makes a sharp corner. u goes
/// once around, v along the profile's length.
CATOPTRIC_API Mesh lathe(std::string name, const std::vector<dvec2>& profile, int around);

/// Returns a ring around the y axis with smooth normals, `around` vertices along it, half as many
/// across.
CATOPTRIC_API Mesh torus(std::string name, double radius, double thickness, int around);

/// Returns a unit ball: a tetrahedron subdivided `levels` times, with midpoints normalised at each
/// level. It has 4^(levels+1) triangles, 2*4^levels + 2 shared vertices and smooth normals. Level 5
/// is the contract's ball: 4096 triangles, 2050 vertices.
CATOPTRIC_API Mesh ball(std::string name, int levels);

} // namespace catoptric::scene
