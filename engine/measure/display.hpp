#pragma once

#include "measure/picture.hpp"

namespace catoptric::measure {

/// Writes the result of `to_display` to `display`, or that of `to_unrounded_display` if
/// `is_rounded` is false. `display` keeps its memory, because the system would have to clear new
/// memory.
void write_display(const Picture& picture, double exposure_stops, bool is_rounded,
                   Picture& display);

} // namespace catoptric::measure
