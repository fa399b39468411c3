#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

/// Shader variants that are chosen per device. The choice of a variant changes the time that a
/// picture takes, and never a byte of the picture.
namespace catoptric::gpu {

inline constexpr std::size_t kVariantCount = 3;

struct ShaderVariant {
    std::string_view name;
    std::array<std::string_view, 2> choices; ///< names of the default and of the alternative
    std::string_view constant;               ///< shader constant that gets the index of the choice
    std::string_view help;
};
std::span<const ShaderVariant, kVariantCount> shader_variants();

/// The index of the choice for each variant, in the table's order.
using VariantChoices = std::array<std::uint8_t, kVariantCount>;

} // namespace catoptric::gpu
