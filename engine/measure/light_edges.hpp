#pragma once

#include "../core/export.hpp"
#include "difference.hpp"

namespace catoptric::measure {

/// A row's error over the mirrors in two parts: pixels that looked within a texel of a light's
/// outline, whose few large errors rule an rmse, and all others. The squares of `rmse` and
/// `rest_rmse` add up to that of the row's rmse.
struct LightEdges {
    double pixels = Difference::kNone; ///< share of the judged mirror pixels that looked there
    double share = Difference::kNone;  ///< of the squared error, 0..1; 0 where there is no error
    double rmse = Difference::kNone;   ///< what they add to the row's
    double rest_rmse = Difference::kNone;
};

/// Of the row's difference over the pixels at light edges, and over all other mirror pixels. Where
/// neither has a finite pixel, every figure is NaN.
CATOPTRIC_API LightEdges light_edges(const Difference& there, const Difference& elsewhere);

} // namespace catoptric::measure
