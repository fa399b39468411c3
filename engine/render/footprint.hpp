#pragma once

#include "core/math.hpp"

#include "shared.h"

#include <cstdint>
#include <span>

/// How fine a mirror's capture must be for the camera that looks at it: neighbouring pixels look on
/// from a curved mirror in directions that spread, and a capture whose texels are as far apart
/// holds all that they can tell from each other. Lengths in any one unit, angles in radians.
namespace catoptric::render {

/// A picture's pixels as its eye sees them: squares of a plane, which turn away from it and lie
/// further off the further they are from the axis.
struct Pixels {
    shared::View view;
    std::uint32_t height = 1; ///< of the picture, in pixels

    /// The smallest angle between neighbours, in a direction whose angle to the axis has this
    /// cosine, above 0; as in the picture's corner beyond that.
    double angle(double cosine) const;
    /// Cosine of the angle between the axis and the picture's corner.
    double corner() const;
};

/// Angle between the directions in which two neighbouring pixels look on from a mirror at
/// `distance` from the eye. Between the two the normal turns by pixel_angle * distance * curvature
/// / cosine, the reflected direction by twice as much. `curvature`: 1 / radius, 0 for a flat
/// mirror, negative for a hollow one, whose footprint is taken as a flat one's where it is smaller
/// (towards its focus it falls to nothing). `cosine`: of the angle of incidence, above 0.
double reflected_footprint(double pixel_angle, double distance, double curvature, double cosine);

/// Texels along the edge of a cube, (pi/2) / footprint: a face of so many spans its right angle
/// with texels of that angle in the mean. Not rounded.
double face_need(double footprint);

/// face_need where it is largest on a ball: about at the point next to the eye, a little further
/// from the axis. 0 for a ball that is not in the picture.
double sphere_need(const Pixels& pixels, const vec3& centre, double radius);

/// face_need where it is largest on a mesh: the largest of its triangles', each with the two
/// principal curvatures that its corners' normals give it (Rusinkiewicz 2004), and with the pixels
/// of the corner that is furthest from the axis. Facets without smooth normals are flat. Both sides
/// reflect; what hides a triangle is not asked. 0 without a triangle in the picture that has an
/// area.
double mesh_need(const Pixels& pixels, std::span<const shared::Vertex> vertices,
                 std::span<const std::uint32_t> indices);

/// The edge of captures that are one cube array: the largest need rounded up to a multiple of 16
/// (so that no need is exceeded by much), at least 16 and at most `most`.
std::uint32_t common_edge(std::span<const double> needs, std::uint32_t most);

} // namespace catoptric::render
