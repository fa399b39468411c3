#pragma once

#include "measure/picture.hpp"

#include <string_view>
#include <vector>

// Parts of a FLIP map.
namespace catoptric::measure {

/// Values of "flip_source" in JSON. FLIP compares either linear floats after exposure, clamping and
/// the sRGB curve without rounding, or files that hold 8 bits.
constexpr std::string_view kFlipSourceFloats = "float", kFlipSourceBytes = "8-bit";

/// How pixels between 0 and 1 store the light that a screen shows: by the sRGB curve or linearly.
enum class PixelEncoding { srgb, linear };

/// Returns the rows [first, end) of the map that `flip` returns. `encoding` is that of both
/// pictures.
std::vector<float> flip_rows(const Picture& a, const Picture& b, int first, int end,
                             PixelEncoding encoding, double pixels_per_degree = 67);

/// Returns the radius of FLIP's filters in pixels.
int flip_filter_radius(double pixels_per_degree = 67);

} // namespace catoptric::measure
