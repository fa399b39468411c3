#pragma once

#include <array>
#include <cmath>
#include <cstddef>

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
        const auto code = static_cast<std::size_t>(std::floor(srgb * 255 + 0.5F));
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

/// Returns the nearest of the 256 values of 8 bits to the sRGB curve of `linear`, which lies
/// between 0 and 1: exactly round(srgb_from_linear(linear) * 255) / 255. Costs a few nanoseconds.
float srgb_in_8_bits(double linear);

} // namespace catoptric::measure
