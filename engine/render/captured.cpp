#include "render/captured.hpp"

#include "core/half.hpp"

#include <cstring>

namespace catoptric::render {

std::size_t Captured::index(std::uint32_t mirror, int cube_face, std::uint32_t x,
                            std::uint32_t y) const {
    return ((std::size_t{6} * mirror + static_cast<std::size_t>(cube_face)) * face + y) * face + x;
}

vec3 Captured::colour(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const {
    std::uint16_t halves[4];
    std::memcpy(halves, colour_bytes.data() + 8 * index(mirror, cube_face, x, y), 8);
    return {from_half(halves[0]), from_half(halves[1]), from_half(halves[2])};
}

float Captured::distance(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y,
                         Format format) const {
    const std::size_t i = index(mirror, cube_face, x, y);
    if (format == Format::r8_unorm) return static_cast<float>(distance_bytes[i]) / 255;
    if (format == Format::r16f) {
        std::uint16_t half;
        std::memcpy(&half, distance_bytes.data() + 2 * i, 2);
        return from_half(half);
    }
    float value;
    std::memcpy(&value, distance_bytes.data() + 4 * i, 4);
    return value;
}

} // namespace catoptric::render
