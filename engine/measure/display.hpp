#pragma once

#include "measure/picture.hpp"

namespace catoptric::measure {

/// Return pixels multiplied by 2^stops. Errors are computed on these values. 0 stops leave each bit
/// as it is.
vec3 apply_exposure(const vec3& pixel, double exposure_stops);
Picture apply_exposure(Picture picture, double exposure_stops);

/// Writes the result of `to_display` to `display`, or that of `to_unrounded_display` if
/// `is_rounded` is false. `display` keeps its memory, because the system would have to clear new
/// memory.
void convert_to_display(const Picture& picture, double exposure_stops, bool is_rounded,
                        Picture& display);

} // namespace catoptric::measure
