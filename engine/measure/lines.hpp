#pragma once

#include "measure/picture.hpp"

// A function that finds wrong pixels that form a line. A viewer notices such a line at once, but no
// mean error shows it.
namespace catoptric::measure {

/// Threshold of a pixel that is off. A pixel is off if its largest channel difference exceeds this
/// value, in linear RGB with both pictures clamped to [0,1].
inline constexpr double kMaxInvisibleDifference = .02;

/// Returns the length in pixels of the longest line in `off`, or 0 without a line. `off` is a mask
/// of whole rows of `width` pixels. Pixels form one set if at most two others lie between them:
/// dilated by 1 they touch, corners included. A set without a 4x4 square of its own pixels is a
/// line. Its length is the longer side of its bounding box. Any other set is a patch, which FLIP
/// measures. Costs a few passes over the mask.
int longest_line_length(const Mask& off, int width);

} // namespace catoptric::measure
