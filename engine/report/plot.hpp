#pragma once

#include "report/comparison.hpp"

#include <string>

namespace catoptric::report {

/// The rows as an SVG for inside a page: median ms against FLIP, both logarithmic, error 0 in a
/// lane of its own, the Pareto front drawn. Empty when no row can be placed.
std::string plot(const Comparison& comparison);

} // namespace catoptric::report
