#pragma once

#include "../core/export.hpp"
#include "interval.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric::measure {

/// Median and spread of a list of measurements, in the unit of the measurements.
struct Summary {
    double median = 0; ///< median of the rounds' medians if there are rounds
    double p05 = 0;    ///< 5th percentile
    double p95 = 0;    ///< 95th percentile
    double mad = 0;    ///< median of the absolute deviations from the median, not scaled
    std::size_t n = 0;
    std::vector<double> samples; ///< the measurements as given, in order
    std::vector<double> rounds;  ///< median of each round; empty if measured without rounds
    Interval ci95;               ///< interval of the median, from the rounds
};

/// Returns the summary of a list. Throws `internal` if the list is empty or has a NaN or infinity.
CATOPTRIC_API Summary summarise(std::span<const double> samples);
/// Returns the summary of measurements in rounds. Each round has at least one sample.
CATOPTRIC_API Summary summarise(std::span<const std::vector<double>> rounds);

/// Returns the value below which `fraction` (0..1) of the values lie. Interpolates linearly between
/// the two nearest ranks, at position fraction * (n - 1) of the sorted list. Throws `internal` if
/// the list is empty. Costs O(n).
CATOPTRIC_API double percentile(std::vector<double> values, double fraction);

} // namespace catoptric::measure
