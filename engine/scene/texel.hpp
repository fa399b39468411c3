#pragma once

#include "scene/texture.hpp"

/// Texels on the processor, where a scene is judged before anything is drawn.
namespace catoptric::scene {

/// One 8-bit value of the sRGB curve as linear light, 0..1.
float linear_from_srgb(std::uint32_t byte);

/// The texel that the point of the mesh's texture space falls into, wrapped as the texture says:
/// red, green, blue and alpha in 0..1, decoded where it is sRGB. Not filtered.
vec4 texel_at(const Texture& texture, const vec2& uv);

/// The mean of all texels, decoded; alpha is left out.
vec3 mean_texel(const Texture& texture);

} // namespace catoptric::scene
