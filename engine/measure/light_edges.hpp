#pragma once

#include "measure/comparison.hpp"

// Splits a row's error into pixels that looked at the outline of a lamp, and all others.
namespace catoptric::measure {

/// Returns the split of a row's error. `there` is its difference over pixels at light edges,
/// `elsewhere` that over all other mirror pixels. All values are NaN if neither has a finite pixel.
LightEdgeErrors split_error_by_light_edges(const Difference& there, const Difference& elsewhere);

} // namespace catoptric::measure
