#pragma once

#include "core/math.hpp"

#include "shared.h"

#include <cstdint>
#include <span>

/// The resolution that a mirror's capture needs for a camera. A curved mirror spreads the
/// directions of neighbouring pixels. A capture whose texels are as far apart as these directions
/// holds every detail that the pixels can show. Lengths are in any one unit, angles in radians.
namespace catoptric::render {

/// The pixels of a picture as the eye sees them: squares on a plane. Towards the edge of the
/// picture they turn away from the eye and lie farther off.
struct PixelGrid {
    shared::View view;
    std::uint32_t height = 1; ///< height of the picture in pixels

    /// Returns the smallest angle between neighbouring pixels. `cosine`: of the direction's angle
    /// to the axis, above 0. Directions beyond the picture's corner count as the corner.
    double pixel_angle(double cosine) const;
    /// Returns the cosine of the angle between the axis and the corner of the picture.
    double corner_cosine() const;
};

/// Returns the angle between the reflected directions of two neighbouring pixels on a mirror at
/// `distance` from the eye. Between the pixels the normal turns by pixel_angle * distance *
/// curvature / cosine, and the reflected direction by twice as much.
/// `curvature`: 1 / radius, 0 for a flat mirror, negative for a concave mirror. Towards its focus,
/// the footprint of a concave mirror shrinks to nothing. The result is therefore never smaller than
/// the footprint of a flat mirror.
/// `cosine`: of the angle of incidence, above 0.
double pixel_footprint(double pixel_angle, double distance, double curvature, double cosine);

/// Returns the texels along the edge of a cube face, (pi/2) / footprint, not rounded. With that
/// many texels across its right angle, a face has the footprint as mean texel angle.
double edge_for_footprint(double footprint);

/// Returns the largest edge_for_footprint on a sphere. The maximum lies near the
/// sphere's point that is closest to the eye. Returns 0 for a sphere outside the picture.
double edge_for_sphere(const PixelGrid& pixels, const vec3& centre, double radius);

/// Returns the largest edge_for_footprint of a mesh's triangles. Each triangle uses the
/// two principal curvatures that its corner normals give (Rusinkiewicz 2004), and the pixel angle
/// at the corner farthest from the axis. Facets without smooth normals are flat. Both sides of a
/// triangle count as reflecting. Objects that hide the mirror are ignored. Returns 0 if no triangle
/// with an area is in the picture.
double edge_for_mesh(const PixelGrid& pixels, std::span<const shared::Vertex> vertices,
                     std::span<const std::uint32_t> indices);

/// Returns the texels along the edge of a cube face that a rough surface needs: with them, the
/// lobe's width alpha is that of the first filtered level (shaders/lib/math/rough.glsl). A finer
/// capture would be filtered to the same picture. `alpha`: above 0.
double edge_for_lobe(double alpha);

/// Returns the common edge of captures in one cube array: the largest need, rounded up to a
/// multiple of 16, at least 16 and at most `most`. The small multiple keeps the excess small.
std::uint32_t choose_common_edge(std::span<const double> needs, std::uint32_t most);

} // namespace catoptric::render
