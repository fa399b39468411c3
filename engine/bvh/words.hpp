#pragma once

#include "core/shader_math.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

/// The words in the texels of a hierarchy; bvh.hpp defines their layout.
namespace catoptric::bvh {

inline std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }
inline float word(std::uint32_t number) { return std::bit_cast<float>(number | f32::kBvhTag); }
inline float id_word(std::size_t number) {
    return word(static_cast<std::uint32_t>(number) & f32::kBvhIdMask);
}
inline std::uint32_t number_of(float word) { return bits(word) & f32::kBvhIdMask; }

} // namespace catoptric::bvh
