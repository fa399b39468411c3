#pragma once

#include "require/world.hpp"
#include "scene/light.hpp"

#include <vector>

/// Functions that find where the shadows of moving objects may fall.
namespace catoptric::require {

/// Most texels by which a shadow lookup may miss the geometric shadow. 1.5 come from lifting the
/// receiver along its normal, 1 from the four taps, and .5 from the caster's outline. The error is
/// along both axes: 3 * sqrt(2) (shaders/lib/shadow.glsl).
inline constexpr double kShadowFilterTexels = 5;

/// The volume that a caster in box B may shade within a box E of everything. The shade is the hull
/// of two boxes, `from` and `to`.
///
/// With a lamp or a point light at L, shaded points are L + t (b - L), t >= 1. With a directional
/// light along a, they are b + t a, t >= 0. While they are in E, t is at most T. T follows from the
/// axes along which B lies wholly to one side of L. The points lie in the hull of B and a second
/// box: B scaled T times away from L, or moved by T a. If B lies around L, both boxes are E.
struct ShadowedVolume {
    Bounds<double> from, to;
};
ShadowedVolume shadowed_volume(const scene::PointLight& light, const Bounds<double>& caster,
                               const Bounds<double>& everything);

/// A part of a receiver that lies in the shadow of a mover: its box, and the volume of the shadow.
struct ShadowReceiver {
    std::size_t caster = 0, receiver = 0; ///< objects
    Bounds<double> box;
    ShadowedVolume shade;
};

/// Finds, for each light and each mover that casts a shadow, the receivers that the shadow may
/// meet. The result is the receiver's box cut by the box of the shade. The shade is enlarged by
/// kShadowFilterTexels of a map whose faces have `edge` texels. With `is_soft`, the shade of a lamp
/// is everything. O(movers * lights * objects).
void find_shadow_receivers(const VisibilityScene& world, std::uint32_t edge, bool is_soft,
                           std::vector<ShadowReceiver>& receivers);

} // namespace catoptric::require
