#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace catoptric::measure {

/// sRGB curve (IEC 61966-2-1) and its inverse, for values in [0,1].
inline double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
inline double linear_from_srgb(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// Evaluates `linear_from_srgb` with a table of the 256 values that 8 bits store.
class SrgbDecodeTable {
public:
    /// Returns exactly the result of the formula. `srgb` is in [0,1].
    double operator()(float srgb) const {
        // Not negative, so the cast rounds down as floor does.
        const float above = srgb * 255 + 0.5F;
        const auto code = static_cast<std::size_t>(static_cast<int>(above));
        return kStored.srgb[code] == srgb ? kStored.linear[code]
                                          : linear_from_srgb(static_cast<double>(srgb));
    }

private:
    struct CodeTable {
        CodeTable();
        std::array<float, 256> srgb{};
        std::array<double, 256> linear{};
    };
    static const CodeTable kStored;
};

/// Encodes light in [0,1] with the sRGB curve and rounds it to the nearest of the 256 values of 8
/// bits.
class SrgbEncoder {
public:
    /// Returns the shared table, which the first call creates.
    static const SrgbEncoder& instance();

    /// Returns exactly round(srgb_from_linear(linear) * 255) / 255. Costs a nanosecond.
    float operator()(double linear) const {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(linear));
        std::size_t code = guesses_[bits >> kDroppedBits];
        // At most one code begins among floats with the same first bits. So one step up is enough,
        // or one step down if the float was rounded up. Conditions are summed because the processor
        // would mispredict branches.
        code += static_cast<std::size_t>(linear >= least_[code + 1]);
        code -= static_cast<std::size_t>(linear < least_[code]);
        return values_[code];
    }

private:
    SrgbEncoder();

    static constexpr int kDroppedBits = 16;
    /// Least linear value that is encoded as each 8-bit code, indexed by the code. Entry 256 is
    /// above 1, so no value in [0,1] reaches it.
    std::array<double, 257> least_{};
    /// Codes indexed by the first bits of a float.
    std::array<std::uint8_t, (std::bit_cast<std::uint32_t>(1.0F) >> kDroppedBits) + 1> guesses_{};
    std::array<float, 256> values_{};
};

inline float rounded_srgb(double linear) { return SrgbEncoder::instance()(linear); }

} // namespace catoptric::measure
