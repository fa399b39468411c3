#include "scene/pattern.hpp"

#include <cmath>

namespace catoptric::scene {

namespace {

/// Returns a pseudo-random number, 0 to 1, for two integers. It is the same on every machine.
double pattern_noise(std::uint32_t x, std::uint32_t y) {
    std::uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return static_cast<double>(h >> 8) / (1 << 24);
}

/// Makes a square sRGB texture. `colour_of(x, y)` returns the colour of a texel, 0 to 255.
template <typename Colour>
Texture make_texture(std::string name, std::uint32_t edge, Colour&& colour_of) {
    auto image = std::make_shared<Image>();
    image->name = std::move(name);
    image->size = {edge, edge};
    for (std::uint32_t y = 0; y < edge; ++y)
        for (std::uint32_t x = 0; x < edge; ++x) {
            const dvec3 colour = glm::clamp(colour_of(x, y), 0.0, 255.0);
            const uvec3 bytes(colour + .5);
            image->texels.push_back(bytes.x | bytes.y << 8 | bytes.z << 16 | 0xff000000u);
        }
    return {.image = std::move(image), .srgb = true};
}

} // namespace

Texture make_checker_texture(uvec3 dark, uvec3 light, std::uint32_t count) {
    return make_texture("checker", 4 * count, [&](std::uint32_t x, std::uint32_t y) {
        return dvec3((x / 4 + y / 4) % 2 == 0 ? dark : light);
    });
}

Texture make_plank_texture(uvec3 colour) {
    return make_texture("planks", 128, [&](std::uint32_t x, std::uint32_t y) {
        const std::uint32_t plank = x / 16, end = (y + 48 * plank) % 128;
        const bool is_joint = x % 16 == 0 || end == 0;
        const double tone = .8 + .25 * pattern_noise(plank, (y + 48 * plank) / 128);
        const double grain = .92 + .16 * pattern_noise(x, y / 24 + 7 * plank);
        return dvec3(colour) * (is_joint ? .45 : tone * grain);
    });
}

Texture make_wallpaper_texture(uvec3 ground, uvec3 figure) {
    return make_texture("wallpaper", 64, [&](std::uint32_t x, std::uint32_t y) {
        const bool is_stripe = x % 32 < 3;
        const double far = std::abs(double(x % 32) - 17) + std::abs(double(y % 32) - 16);
        return dvec3(is_stripe || (far < 7 && far > 3) ? figure : ground);
    });
}

Texture make_cloth_texture(uvec3 colour) {
    return make_texture("cloth", 32, [&](std::uint32_t x, std::uint32_t y) {
        const bool is_over = (x / 2 + y / 2) % 2 == 0;
        return dvec3(colour) * ((is_over ? 1 : .8) * (.92 + .16 * pattern_noise(x, y)));
    });
}

} // namespace catoptric::scene
