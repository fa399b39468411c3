#pragma once

#include "measure/comparison.hpp"

#include <span>
#include <vector>

// Summaries of measurements.
namespace catoptric::measure {

/// Throws `internal` if the list is empty or has a NaN or infinity.
SampleSummary summarise(std::span<const double> samples);
/// Each round has at least one sample.
SampleSummary summarise(std::span<const std::vector<double>> rounds);

/// Returns the value below which `fraction` (0..1) of the values lie. Interpolates linearly between
/// the two nearest ranks, at position fraction * (n - 1) of the sorted list. Throws `internal` if
/// the list is empty. Costs O(n).
double percentile(std::vector<double> values, double fraction);

} // namespace catoptric::measure
