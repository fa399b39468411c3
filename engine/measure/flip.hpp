#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace catoptric::measure {

/// Of which values FLIP of renderings is figured, as "flip_source" in JSON says: linear floats
/// through exposure, clamping and the sRGB curve, not rounded; or of files that hold 8 bits.
constexpr std::string_view kFlipOfFloats = "float", kFlipOfBytes = "8-bit";

/// LDR-FLIP of two pictures as the screen shows them (sRGB-encoded, [0,1], see
/// `to_unrounded_display`): for each pixel, row-major, how different they look to somebody who
/// flips between them, 0 (not at all) .. 1. Symmetric; equal pictures give exactly 0. Andersson et
/// al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020, as its authors' program
/// (1.1 and later) does it; 67 is a 4K screen 0.7 m wide seen from 0.7 m. Pictures of different or
/// no size are refused (`Failure::bad_data`). Works in double, in tiles, on every core; costs about
/// 0.07 us (one core) and 4 bytes a pixel at 67 pixels per degree.
CATOPTRIC_API std::vector<float> flip(const Picture& a_display, const Picture& b_display,
                                      double pixels_per_degree = 67);

/// Returns the rows from `first` to before `end` of what `flip` returns.
CATOPTRIC_API std::vector<float> flip_of_rows(const Picture& a_display, const Picture& b_display,
                                              int first, int end, double pixels_per_degree = 67);

/// How many pixels around one FLIP looks at in each direction.
CATOPTRIC_API int flip_reach(double pixels_per_degree = 67);

/// Mean of a FLIP map over the pixels that count; NaN when none does.
CATOPTRIC_API double flip_mean(std::span<const float> flip_map, const Mask& mask = {});

} // namespace catoptric::measure
