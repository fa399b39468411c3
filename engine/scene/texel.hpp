#pragma once

#include "scene/material.hpp"

/// Texture lookups on the processor, for scenes that are classified before anything is drawn.
namespace catoptric::scene {

/// Returns an sRGB value of 0 to 1 as linear light.
double linear_from_srgb_value(double value);
/// Returns an 8-bit sRGB value as linear light, 0 to 1.
float linear_from_srgb(std::uint32_t byte);

/// Returns the texel at a point of the mesh's texture space, wrapped as the texture says and not
/// filtered. Red, green, blue and alpha are in 0 to 1, decoded if the texture is sRGB.
vec4 read_texel(const Texture& texture, const vec2& uv);

/// Returns the mean of all texels, decoded, without alpha.
vec3 mean_texel(const Texture& texture);

} // namespace catoptric::scene
