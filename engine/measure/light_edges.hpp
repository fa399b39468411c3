#pragma once

#include "measure/comparison.hpp"

// Splits a row's error into pixels that looked at the outline of a lamp, and all others.
namespace catoptric::measure {

/// Error of a row over the mirrors in two parts: pixels that looked within a texel of a light's
/// outline, whose few large errors dominate an rmse, and the rest. Their squares add up.
struct LightEdgeErrors {
    /// Share of the finite mirror pixels that looked at a light's edge, 0..1.
    double pixels = Difference::kNone;
    /// Share of the squared error at light edges, 0..1; 0 if there is no error.
    double share = Difference::kNone;
    double rmse = Difference::kNone; ///< part of the row's rmse at light edges
    double rest_rmse = Difference::kNone;
};

/// Returns the split of a row's error. `there` is its difference over pixels at light edges,
/// `elsewhere` that over all other mirror pixels. All values are NaN if neither has a finite pixel.
LightEdgeErrors split_by_light_edges(const Difference& there, const Difference& elsewhere);

} // namespace catoptric::measure
