#pragma once

#include "require/world.hpp"

#include <vector>

/// Where shadows of things that move may fall.
namespace catoptric::require {

/// Texels of a shadow map by which what is shaded may lie off where the shadow geometrically is:
/// 1.5 that a receiver is lifted along its normal, 1 of the four taps, .5 by which a caster's
/// outline is off, each along both axes: 3 * sqrt(2) (shaders/lib/shadow.glsl).
inline constexpr double kShadowTexels = 5;

/// Of a light and a box B what it may shade of a box E that all lies in: places L + t (b - L), t >=
/// 1, of a lamp or a point, b + t a, t >= 0, of a directional light. As long as they are in E t is
/// at most T, found from the axes along which B lies wholly to one side of L; so they lie in the
/// hull of B and of B put T times as far (or moved by T a), which is a box as well. Both are
/// returned; E twice where B lies around L.
struct Shade {
    Bounds<double> from, to;
};
Shade shade_of(const scene::PointLight& light, const Bounds<double>& caster,
               const Bounds<double>& everything);

/// A part of a receiver that a mover may shade, and the shade that it lies in.
struct Landing {
    std::size_t caster = 0, receiver = 0; ///< objects
    Bounds<double> box;
    Shade shade;
};

/// For each light and mover that casts a shadow the receivers that its shadow may meet: the
/// receiver's box cut with that of the shade, larger by kShadowTexels of a map whose faces have
/// `edge` texels. O(movers * lights * objects).
void find_landings(const World& world, std::uint32_t edge, std::vector<Landing>& landings);

} // namespace catoptric::require
