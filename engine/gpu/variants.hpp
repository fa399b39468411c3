#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

/// What of the shaders a device may have otherwise than it is by default: it changes no byte of a
/// picture, only how soon it is there.
namespace catoptric::gpu {

inline constexpr std::size_t kVariants = 3;

struct Variant {
    std::string_view name;
    std::array<std::string_view, 2> choices; ///< the default, the other
    std::string_view constant;               ///< of shaders: the index of the choice
    std::string_view help;
};
std::span<const Variant, kVariants> variants();

/// The index of the choice of each, in the table's order.
using Choices = std::array<std::uint8_t, kVariants>;

} // namespace catoptric::gpu
