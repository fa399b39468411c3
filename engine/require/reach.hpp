#pragma once

#include "require/frustum.hpp"
#include "require/world.hpp"

#include <span>

/// Which faces of flat mirrors are asked for, and which lights reach what is seen.
namespace catoptric::require {

/// Facets and normals of a flat mirror may lean by this angle, radians, and what is filtered may
/// take texels from so far beside where it looks.
inline constexpr double kLean = .05;

/// The unit normal of a mesh all of whose triangles and vertices' normals point one way within
/// kLean / 2, in the mesh's own space; zero for any other. O(vertices).
dvec3 flat_normal(const scene::Mesh& mesh);

/// Faces of the capture of a flat mirror with this normal in the world, where `viewers` are the
/// boxes of all who may look at it: one side of the mirror's plane has them all or it reflects to
/// both. What is reflected stays on the viewers' side of the plane through the mirror, in which the
/// capture's centre lies, and so does the place where a reflected ray ends: no direction from the
/// centre to such a place points to behind the plane, nor does a reflected ray's own. A viewer that
/// lies in the plane, within `margin`, sees nothing of it: panels on one wall.
Faces faces_of_flat(const Bounds<double>& mirror, const dvec3& normal, double margin,
                    std::span<const Bounds<double>> viewers);

/// Whether the light may shine on something in the box: it is within its range and, of a lamp,
/// in front of it.
bool may_light(const scene::PointLight& light, const Bounds<double>& box, double margin);

} // namespace catoptric::require
