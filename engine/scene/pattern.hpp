#pragma once

#include "scene/material.hpp"

/// Procedural textures for the built-in scenes.
namespace catoptric::scene {

/// Makes squares of two colours (sRGB, 0 to 255), `count` along each edge, 4 x 4 texels each.
Texture make_checker_texture(uvec3 dark, uvec3 light, std::uint32_t count);

/// Makes planks along v with grain and staggered joints; 128 x 128 texels.
Texture make_plank_texture(uvec3 colour);

/// Makes a wallpaper: stripes along v with a row of diamonds between them; 64 x 64 texels.
Texture make_wallpaper_texture(uvec3 ground, uvec3 figure);

/// Makes woven threads; 32 x 32 texels.
Texture make_cloth_texture(uvec3 colour);

} // namespace catoptric::scene
