#pragma once

#include "scene/texture.hpp"

/// Textures of our own making for the built-in scenes.
namespace catoptric::scene {

/// Squares of two colours (sRGB, 0 to 255), `count` to an edge, four texels each.
Texture checker(uvec3 dark, uvec3 light, std::uint32_t count);

/// Planks along v with grain, joints staggered; 128 x 128 texels.
Texture planks(uvec3 colour);

/// A wallpaper: stripes along v with a row of diamonds between them; 64 x 64 texels.
Texture wallpaper(uvec3 ground, uvec3 figure);

/// Woven threads; 32 x 32 texels.
Texture cloth(uvec3 colour);

} // namespace catoptric::scene
