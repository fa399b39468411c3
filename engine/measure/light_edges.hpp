#pragma once

#include "../core/export.hpp"
#include "difference.hpp"

namespace catoptric::measure {

/// Error of a row over the mirrors in two parts. One part is the pixels that looked within a texel
/// of a light's outline, whose few large errors dominate an rmse. The other part is all other
/// mirror pixels. The squares of `rmse` and `rest_rmse` add up to the square of the row's rmse.
struct LightEdges {
    /// Share of the finite mirror pixels that looked at a light's edge, 0..1.
    double pixels = Difference::kNone;
    /// Share of the squared error at light edges, 0..1; 0 if there is no error.
    double share = Difference::kNone;
    double rmse = Difference::kNone; ///< part of the row's rmse at light edges
    double rest_rmse = Difference::kNone;
};

/// Returns the split of a row's error. `there` is its difference over pixels at light edges,
/// `elsewhere` that over all other mirror pixels. All values are NaN if neither has a finite pixel.
CATOPTRIC_API LightEdges light_edges(const Difference& there, const Difference& elsewhere);

} // namespace catoptric::measure
