#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

namespace catoptric::scene {

/// How far above its support a part of a shipped scene stands, in metres. If two
/// surfaces lie in one plane, chance decides which one a picture shows.
inline constexpr double kStandingGap = .001;

/// Two triangles (a b c) (a c d) with the flat normal normalize(cross(b-a, c-a)).
CATOPTRIC_API Mesh quad(std::string name, dvec3 a, dvec3 b, dvec3 c, dvec3 d);

/// The wall of the box [lo, hi] in direction +X -X +Y -Y +Z -Z (as the faces of a cube map), facing
/// in.
CATOPTRIC_API Mesh wall(int face, dvec3 lo, dvec3 hi);

/// The box [lo, hi] seen from outside, flat normals; each side shows texture space [0,1]^2.
CATOPTRIC_API Mesh box(std::string name, dvec3 lo, dvec3 hi);

/// What a profile of (radius, height) makes when it turns around the y axis, `around` vertices to a
/// turn; the outside lies to the right of the way along the profile when that goes upwards. Normals
/// are those of the curve through the points, but for sharp corners: a point that is given twice.
/// u goes once around, v along the profile's length.
CATOPTRIC_API Mesh lathe(std::string name, const std::vector<dvec2>& profile, int around);

/// A ring around the y axis with smooth normals, `around` vertices along it, half as many across.
CATOPTRIC_API Mesh torus(std::string name, double radius, double thickness, int around);

/// Unit ball from a tetrahedron subdivided `levels` times, midpoints normalised at each level:
/// 4^(levels+1) triangles, 2*4^levels + 2 shared vertices, smooth normals. Level 5 is the
/// contract's ball: 4096 triangles, 2050 vertices.
CATOPTRIC_API Mesh ball(std::string name, int levels);

} // namespace catoptric::scene
