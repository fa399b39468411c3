#pragma once

#include "core/shader_math.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

/// Functions that pack and unpack the words in the texels of a hierarchy. bvh.hpp defines the
/// layout of the words.
namespace catoptric::bvh {

inline std::uint32_t float_to_bits(float value) { return std::bit_cast<std::uint32_t>(value); }
inline float pack_word(std::uint32_t number) {
    return std::bit_cast<float>(number | f32::kBvhNormalFloatBit);
}
inline float pack_number(std::size_t number) {
    return pack_word(static_cast<std::uint32_t>(number) & f32::kBvhIdMask);
}
inline std::uint32_t unpack_number(float word) { return float_to_bits(word) & f32::kBvhIdMask; }

} // namespace catoptric::bvh
