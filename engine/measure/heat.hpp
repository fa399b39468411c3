#pragma once

#include "measure/picture.hpp"

#include <span>

namespace catoptric::measure {

/// Colour of a value in [0,1], display space: black, purple, magenta, orange, pale yellow.
/// Lightness (CIE L*) rises evenly with the value, so that order survives grey print and colour
/// blindness. Values outside are clamped; NaN is cyan, which the map has nowhere else.
vec3 heat_colour(float value);

/// An error map, row-major, `width` to a row, as a picture for `write_png`; `high` is the value at
/// the top of the map. A map whose size is not width * height is `Failure::internal`.
Picture heat(std::span<const float> map, int width, int height, float high = 1);

} // namespace catoptric::measure
