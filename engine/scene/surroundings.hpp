#pragma once

#include "core/math.hpp"
#include "scene/environment.hpp"

#include <array>

/// What an environment shows and what it lights, in double precision.
namespace catoptric::scene {

/// What is seen in a direction, unit, scaled and turned.
dvec3 radiance(const Environment& environment, const dvec3& direction);

/// Coefficients for `irradiance` of shaders/lib/math/environment.glsl: what nine spherical
/// harmonics keep of the light from all around (Ramamoorthi and Hanrahan 2001), texels weighted by
/// their solid angle, those of `studio` at 512x256 places. O(texels).
std::array<dvec3, 9> irradiance_coefficients(const Environment& environment);

} // namespace catoptric::scene
