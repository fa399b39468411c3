#pragma once

#include "measure/picture.hpp"

#include <span>

namespace catoptric::measure {

/// Returns the display-space colour of a value in [0,1]: black, purple, magenta, orange, pale
/// yellow. Lightness (CIE L*) rises evenly with the value, so the order survives grey print and
/// colour blindness. Values outside are clamped. NaN becomes cyan, a colour that the map does not
/// contain.
vec3 heat_colour(float value);

/// Returns the picture of a row-major error map, ready for `write_png`. `high` is the value that
/// gets the last colour. Throws `internal` if the map has not width * height values or `high` is
/// not positive.
Picture make_heat_map(std::span<const float> map, int width, int height, float high = 1);

} // namespace catoptric::measure
