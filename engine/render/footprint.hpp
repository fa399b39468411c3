#pragma once

#include "core/math.hpp"

#include "shared.h"

#include <cstdint>
#include <span>

/// How fine a mirror's capture must be for the camera that looks at it: neighbouring pixels look on
/// from a curved mirror in directions that spread, and a capture whose texels are as far apart
/// holds all that they can tell from each other. Lengths in any one unit, angles in radians.
namespace catoptric::render {

/// Mean angle between neighbouring pixels along the picture's height.
double pixel_angle(double vertical_fov_degrees, std::uint32_t height);

/// Angle between the directions in which two neighbouring pixels look on from a mirror at
/// `distance` from the eye. Between the two the normal turns by pixel_angle * distance * curvature
/// / cosine, the reflected direction by twice as much. `curvature`: 1 / radius, 0 for a flat
/// mirror, negative for a hollow one, whose footprint is taken as a flat one's where it is smaller
/// (towards its focus it falls to nothing). `cosine`: of the angle of incidence, above 0.
double reflected_footprint(double pixel_angle, double distance, double curvature, double cosine);

/// Texels along the edge of a cube, (pi/2) / footprint: a face of so many spans its right angle
/// with texels of that angle in the mean. Not rounded.
double face_need(double footprint);

/// face_need where it is largest on a ball: at the point next to the eye. `distance`: of its
/// centre.
double sphere_need(double pixel_angle, double distance, double radius);

/// face_need where it is largest on a mesh: the largest of its triangles', each with the two
/// principal curvatures that its corners' normals give it (Rusinkiewicz 2004). Facets without
/// smooth normals are flat. Both sides reflect; what hides a triangle is not asked. 0 without a
/// triangle that has an area.
double mesh_need(double pixel_angle, const vec3& eye, std::span<const shared::Vertex> vertices,
                 std::span<const std::uint32_t> indices);

/// The edge of captures that are one cube array: the largest need rounded up to a multiple of 16
/// (so that no need is exceeded by much), at least 16 and at most `most`.
std::uint32_t common_edge(std::span<const double> needs, std::uint32_t most);

} // namespace catoptric::render
