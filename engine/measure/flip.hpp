#pragma once

#include "measure/picture.hpp"

#include <string_view>
#include <vector>

// Parts of a FLIP map.
namespace catoptric::measure {

/// Values of "flip_source" in JSON. FLIP compares either linear floats after exposure, clamping and
/// the sRGB curve without rounding, or files that hold 8 bits.
constexpr std::string_view kFlipOfFloats = "float", kFlipOfBytes = "8-bit";

/// Returns the rows [first, end) of the map that `flip` returns.
std::vector<float> flip_of_rows(const Picture& a_display, const Picture& b_display, int first,
                                int end, double pixels_per_degree = 67);

/// Returns the radius of FLIP's filters in pixels.
int flip_filter_radius(double pixels_per_degree = 67);

} // namespace catoptric::measure
