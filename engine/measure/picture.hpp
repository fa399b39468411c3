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
    /// Black.
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

/// One byte a pixel, row-major; non-zero counts. Empty means "every pixel".
using Mask = std::vector<std::uint8_t>;

/// Times 2^stops: what errors are figured on. 0 stops leave every bit as it is.
CATOPTRIC_API vec3 exposed(const vec3& pixel, double exposure_stops);
CATOPTRIC_API Picture exposed(Picture picture, double exposure_stops);

/// What the screen shows: `picture` times 2^exposure_stops, clamped to [0,1], sRGB curve, rounded
/// to 8 bits; values in [0,1] again (multiples of 1/255). NaN becomes 0.
CATOPTRIC_API Picture to_display(const Picture& picture, double exposure_stops = 0);

/// The same without the rounding to 8 bits: what FLIP of two renderings is figured on.
CATOPTRIC_API Picture to_unrounded_display(const Picture& picture, double exposure_stops = 0);

} // namespace catoptric::measure
