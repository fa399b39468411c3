#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace catoptric::measure {

/// The sRGB curve (IEC 61966-2-1) and its inverse, for values in [0,1].
inline double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
inline double linear_from_srgb(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

/// `linear_from_srgb` with a table of the values that 8 bits store.
class LinearTable {
public:
    /// Returns exactly what the formula does. `srgb`: in [0,1].
    double operator()(float srgb) const {
        const float above = srgb * 255 + 0.5F; // not negative: the cast rounds it down, as floor
        const auto code = static_cast<std::size_t>(static_cast<int>(above));
        return kStored.srgb[code] == srgb ? kStored.linear[code]
                                          : linear_from_srgb(static_cast<double>(srgb));
    }

private:
    struct Stored {
        Stored();
        std::array<float, 256> srgb{};
        std::array<double, 256> linear{};
    };
    static const Stored kStored;
};

/// Returns the nearest of the 256 values of 8 bits to the sRGB curve of light between 0 and 1.
class EightBitCurve {
public:
    /// The only one, made at the first call.
    static const EightBitCurve& get();

    /// Returns exactly round(srgb_from_linear(linear) * 255) / 255. Costs a nanosecond.
    float operator()(double linear) const {
        const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(linear));
        std::size_t code = guesses_[bits >> kDropped];
        // At most one code begins among floats with the same first bits: a step up is enough, or
        // one down if the float was rounded up. Sums of conditions, as the processor would guess
        // branches wrong.
        code += static_cast<std::size_t>(linear >= least_[code + 1]);
        code -= static_cast<std::size_t>(linear < least_[code]);
        return values_[code];
    }

private:
    EightBitCurve();

    static constexpr int kDropped = 16;
    std::array<double, 257> least_{}; ///< of each code; ends with a value that is never reached
    /// By the first bits of a float.
    std::array<std::uint8_t, (std::bit_cast<std::uint32_t>(1.0F) >> kDropped) + 1> guesses_{};
    std::array<float, 256> values_{};
};

inline float srgb_in_8_bits(double linear) { return EightBitCurve::get()(linear); }

} // namespace catoptric::measure
