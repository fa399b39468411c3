#pragma once

#include "report/comparison.hpp"
#include "report/stacked_bars.hpp"

namespace catoptric::report {

/// Returns a bar for each row with timed passes: the medians of its passes, in ms. Passes are
/// summed by kind, which is the part of their name before '/'. Kinds stand in the order of their
/// first pass.
StackedBars pass_time_bars(const Comparison& comparison);

} // namespace catoptric::report
