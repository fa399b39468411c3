#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace catoptric {

inline constexpr float kMaxHalf = 65504;
inline constexpr std::uint16_t kMaxHalfBits = 0x7bff;

/// Returns the value of a 16-bit float (IEEE 754 binary16).
inline float half_to_float(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const float size = exponent == 31 ? (mantissa ? std::numeric_limits<float>::quiet_NaN()
                                                  : std::numeric_limits<float>::infinity())
                       : exponent == 0
                           ? std::ldexp(static_cast<float>(mantissa), -24)
                           : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
    return bits >> 15 ? -size : size;
}

} // namespace catoptric
