#include "render/captured.hpp"

#include "core/half.hpp"

#include <cstring>

namespace catoptric::render {

std::size_t CapturedCubes::index(std::uint32_t mirror, int cube_face, std::uint32_t x,
                                 std::uint32_t y) const {
    return ((std::size_t{6} * mirror + static_cast<std::size_t>(cube_face)) * face + y) * face + x;
}

vec3 CapturedCubes::colour(std::uint32_t mirror, int cube_face, std::uint32_t x,
                           std::uint32_t y) const {
    std::uint16_t halves[4];
    std::memcpy(halves, colour_bytes.data() + 8 * index(mirror, cube_face, x, y), 8);
    return {half_to_float(halves[0]), half_to_float(halves[1]), half_to_float(halves[2])};
}

float CapturedCubes::distance(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y,
                              TexelFormat format) const {
    const std::size_t i = index(mirror, cube_face, x, y);
    if (format == TexelFormat::r8_unorm) return static_cast<float>(distance_bytes[i]) / 255;
    if (format == TexelFormat::r16f) {
        std::uint16_t half;
        std::memcpy(&half, distance_bytes.data() + 2 * i, 2);
        return half_to_float(half);
    }
    float value;
    std::memcpy(&value, distance_bytes.data() + 4 * i, 4);
    return value;
}

} // namespace catoptric::render
