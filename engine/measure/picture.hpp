#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace catoptric::measure {

/// Row-major RGB picture, top row first, linear light, float.
struct Picture {
    int width = 0;
    int height = 0;
    std::vector<vec3> pixels;

    Picture() = default;
    /// Makes a black picture.
    Picture(int columns, int rows)
        : width(columns), height(rows),
          pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), vec3(0)) {}
    vec3& at(int x, int y) { return pixels[index(x, y)]; }
    const vec3& at(int x, int y) const { return pixels[index(x, y)]; }

private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(x);
    }
};

/// Mask with one byte a pixel, row-major. A pixel counts if its byte is not 0. An empty mask means
/// "all pixels".
using Mask = std::vector<std::uint8_t>;

/// Return pixels multiplied by 2^stops. Errors are computed on these values. 0 stops leave each bit
/// as it is.
CATOPTRIC_API vec3 exposed(const vec3& pixel, double exposure_stops);
CATOPTRIC_API Picture exposed(Picture picture, double exposure_stops);

/// Returns the picture as displayed: multiplied by 2^exposure_stops, clamped to [0,1], through the
/// sRGB curve and rounded to 8 bits. Values are in [0,1] (multiples of 1/255). NaN becomes 0.
CATOPTRIC_API Picture to_display(const Picture& picture, double exposure_stops = 0);

/// Returns the same without the rounding to 8 bits. FLIP of two renderings compares these values.
CATOPTRIC_API Picture to_unrounded_display(const Picture& picture, double exposure_stops = 0);

} // namespace catoptric::measure
