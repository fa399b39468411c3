#pragma once

#include "report/comparison.hpp"

#include <string>

namespace catoptric::report {

/// Returns the rows as an SVG to embed in a page: median ms against FLIP, both logarithmic. Error 0
/// has a separate lane and the Pareto front is drawn. Empty if no row can be placed.
std::string plot(const Comparison& comparison);

} // namespace catoptric::report
