#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <span>
#include <vector>

namespace catoptric::measure {

/// LDR-FLIP of two pictures as the screen shows them (sRGB-encoded, [0,1], see `to_display`): for
/// each pixel, row-major, how different they look to somebody who flips between them, 0 (not at
/// all) .. 1. Symmetric; equal pictures give exactly 0. Andersson et al., "FLIP: A Difference
/// Evaluator for Alternating Images", HPG 2020, as its authors' program (1.1 and later) does it;
/// 67 is a 4K screen 0.7 m wide seen from 0.7 m.
/// Pictures of different or no size are refused (`Failure::bad_data`). Works in double, on every
/// core; costs about 0.6 us (one core) and 150 bytes a pixel at 67 pixels per degree.
CATOPTRIC_API std::vector<float> flip(const Picture& a_display, const Picture& b_display,
                                      double pixels_per_degree = 67);

/// Mean of a FLIP map over the pixels that count; NaN when none does.
CATOPTRIC_API double flip_mean(std::span<const float> flip_map, const Mask& mask = {});

} // namespace catoptric::measure
