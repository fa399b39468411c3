#pragma once

#include "core/math.hpp"
#include "measure/lines.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

// Differences of two pixels in linear RGB after exposure (measure/display.hpp), both clamped to
// [0,1].
namespace catoptric::measure {

inline bool is_finite_pixel(const vec3& pixel) {
    return std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z);
}

/// Returns the pixel clamped to [0,1]. NaN stays NaN.
inline dvec3 clamp_pixel(const vec3& pixel) {
    const auto one = [](float value) { return std::clamp(static_cast<double>(value), 0.0, 1.0); };
    return {one(pixel.x), one(pixel.y), one(pixel.z)};
}

/// Returns the absolute difference of each channel, 0..1.
inline dvec3 absolute_difference(const vec3& a, const vec3& b) {
    return glm::abs(clamp_pixel(a) - clamp_pixel(b));
}

/// Returns whether a channel differs by more than kMaxInvisibleDifference. Both pixels must
/// be finite.
inline bool differs_visibly(const vec3& a, const vec3& b) {
    const dvec3 channels = absolute_difference(a, b);
    return std::max({channels.x, channels.y, channels.z}) > kMaxInvisibleDifference;
}

/// Returns the mean squared difference over the channels, 0..1, or NaN if a pixel is not finite.
inline double squared_error(const vec3& a, const vec3& b) {
    if (!is_finite_pixel(a) || !is_finite_pixel(b)) return std::numeric_limits<double>::quiet_NaN();
    const dvec3 difference = absolute_difference(a, b);
    return glm::dot(difference, difference) / 3;
}

} // namespace catoptric::measure
