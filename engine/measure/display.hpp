#pragma once

#include "measure/picture.hpp"

namespace catoptric::measure {

/// Writes to `display` what `to_display` returns or, if not `is_rounded`, `to_unrounded_display`.
/// `display` keeps its memory, which saves the system's clearing of new memory.
void write_display(const Picture& picture, double exposure_stops, bool is_rounded,
                   Picture& display);

} // namespace catoptric::measure
