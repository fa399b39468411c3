#pragma once

#include "measure/picture.hpp"

// Wrong pixels that stand in a line, which the eye finds at once and no mean shows.
namespace catoptric::measure {

/// A pixel is off when its largest channel difference, linear, both clamped to [0,1], exceeds this.
inline constexpr double kOff = .02;

/// Length in pixels of the longest line of `off`, a mask of whole rows of `width` pixels; 0 without
/// one. Pixels belong together where no more than two others lie between them (each dilated by 1,
/// they touch, corners included). A set without a 4x4 square of its own pixels is a line, and as
/// long as the longest side of its box; any other is a patch, which FLIP sees. Costs a few passes
/// over the mask.
int longest_line(const Mask& off, int width);

} // namespace catoptric::measure
