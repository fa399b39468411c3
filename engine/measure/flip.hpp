#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace catoptric::measure {

/// Values of "flip_source" in JSON. FLIP compares either linear floats after exposure, clamping and
/// the sRGB curve without rounding, or files that hold 8 bits.
constexpr std::string_view kFlipOfFloats = "float", kFlipOfBytes = "8-bit";

/// Returns the LDR-FLIP map of two pictures as displayed (sRGB-encoded, [0,1], see
/// `to_unrounded_display`). The map is row-major. Each pixel is 0 (no visible difference) to 1 and
/// says how different the pictures look to a viewer who flips between them. The map is symmetric,
/// and equal pictures give exactly 0. Method: Andersson et al., "FLIP: A Difference Evaluator for
/// Alternating Images", HPG 2020, as the authors' program (1.1 and later) implements it. 67 pixels
/// per degree is a 4K screen 0.7 m wide seen from 0.7 m. Throws `bad_data` if the pictures differ
/// in size or have no pixel, and `usage` unless `pixels_per_degree` is 1 to 1000. Works in double,
/// in tiles, on all cores. Costs about 0.07 us (one core) and 4 bytes a pixel at 67 pixels per
/// degree.
CATOPTRIC_API std::vector<float> flip(const Picture& a_display, const Picture& b_display,
                                      double pixels_per_degree = 67);

/// Returns the rows [first, end) of the map that `flip` returns.
CATOPTRIC_API std::vector<float> flip_of_rows(const Picture& a_display, const Picture& b_display,
                                              int first, int end, double pixels_per_degree = 67);

/// Returns the radius of FLIP's filters in pixels.
CATOPTRIC_API int flip_reach(double pixels_per_degree = 67);

/// Returns the mean of a FLIP map over the pixels of the mask, or NaN if the mask has none.
CATOPTRIC_API double flip_mean(std::span<const float> flip_map, const Mask& mask = {});

} // namespace catoptric::measure
