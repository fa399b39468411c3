#pragma once

#include "require/frustum.hpp"
#include "require/world.hpp"
#include "scene/light.hpp"

#include <span>

/// Functions that find the required faces of flat mirrors' captures, and the lights that reach a
/// visible surface.
namespace catoptric::require {

/// Most angle by which facets and normals of a flat mirror may lean, in radians. Filtered lookups
/// may also read texels up to this angle beside their direction.
inline constexpr double kMaxNormalDeviation = .05;

/// Returns the unit normal of a flat mesh in its own space; zero for other meshes. In a flat mesh,
/// all facets and vertex normals point one way within kMaxNormalDeviation / 2. O(vertices).
dvec3 find_flat_normal(const scene::Mesh& mesh);

/// Returns the needed faces of the capture of a flat mirror. `normal` is in world space. `viewers`
/// are the boxes of all possible viewers: the eye and other mirrors.
///
/// If all viewers lie on one side of the mirror's plane, the mirror only reflects to this side.
/// Reflected rays and the points where they end also lie on this side of the plane. The capture's
/// centre lies in the plane. No direction from the centre to such a point leads behind the plane,
/// nor does the direction of a reflected ray.
///
/// A viewer within `margin` of the plane sees nothing of the mirror, such as another panel on the
/// same wall. If viewers lie on both sides, all faces are needed.
FaceBits needed_faces(const Bounds<double>& mirror, const dvec3& normal, double margin,
                      std::span<const Bounds<double>> viewers);

/// Returns whether the light may shine on something in the box: within the light's range and, for a
/// lamp, in front of the lamp.
bool may_light_reach(const scene::PointLight& light, const Bounds<double>& box, double margin);

} // namespace catoptric::require
