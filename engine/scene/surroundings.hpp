#pragma once

#include "core/math.hpp"
#include "scene/scene.hpp"

#include <array>

/// Functions that compute radiance and irradiance of an environment in double precision.
namespace catoptric::scene {

/// Returns the radiance in a unit direction, with the environment's scale and rotation applied.
dvec3 environment_radiance(const Environment& environment, const dvec3& direction);

/// Returns the coefficients for `irradiance` of shaders/lib/math/environment.glsl. They describe
/// the light from all around by nine spherical harmonics (Ramamoorthi and Hanrahan 2001). Texels
/// are weighted by their solid angle; `studio` is sampled at 512x256 places. O(texels).
std::array<dvec3, 9> irradiance_coefficients(const Environment& environment);

} // namespace catoptric::scene
