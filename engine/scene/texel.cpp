#include "scene/texel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::scene {

namespace {

vec4 decode_texel(const Texture& texture, std::uint32_t texel) {
    vec4 value;
    for (int channel = 0; channel < 4; ++channel) {
        const std::uint32_t byte = texel >> (8 * channel) & 255u;
        const bool is_curved = texture.srgb && channel < 3;
        value[channel] = is_curved ? linear_from_srgb(byte) : static_cast<float>(byte) / 255.0f;
    }
    return value;
}

/// Returns the texel's index along one side of the image.
std::uint32_t wrap_index(Texture::Wrap wrap, double coordinate, std::uint32_t size) {
    const double whole = std::floor(coordinate * size), n = size;
    if (!std::isfinite(whole)) return 0;
    if (wrap == Texture::Wrap::clamp)
        return static_cast<std::uint32_t>(std::clamp(whole, 0.0, n - 1));
    if (wrap == Texture::Wrap::repeat)
        return static_cast<std::uint32_t>(whole - n * std::floor(whole / n));
    const double twice = whole - 2 * n * std::floor(whole / (2 * n)); // 0 .. 2n - 1
    return static_cast<std::uint32_t>(twice < n ? twice : 2 * n - 1 - twice);
}

} // namespace

double linear_from_srgb_value(double value) { // IEC 61966-2-1
    return value <= .04045 ? value / 12.92 : std::pow((value + .055) / 1.055, 2.4);
}

float linear_from_srgb(std::uint32_t byte) {
    static const std::array<float, 256> kLinearFromSrgbTable = [] {
        std::array<float, 256> table;
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] = static_cast<float>(linear_from_srgb_value(static_cast<double>(i) / 255));
        return table;
    }();
    return kLinearFromSrgbTable[byte & 255u];
}

vec4 read_texel(const Texture& texture, const vec2& uv) {
    const Image& image = *texture.image;
    const vec3 from(uv, 1);
    const std::uint32_t x = wrap_index(texture.wrap_u, glm::dot(texture.u_row, from), image.size.x),
                        y = wrap_index(texture.wrap_v, glm::dot(texture.v_row, from), image.size.y);
    return decode_texel(texture, image.texels[std::size_t{y} * image.size.x + x]);
}

vec3 mean_texel(const Texture& texture) {
    dvec3 sum(0);
    for (const std::uint32_t texel : texture.image->texels)
        sum += dvec3(decode_texel(texture, texel));
    return vec3(sum / static_cast<double>(std::max<std::size_t>(1, texture.image->texels.size())));
}

} // namespace catoptric::scene
