#pragma once

#include "../core/export.hpp"
#include "interval.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric::measure {

/// Location and spread of a list of measurements, in their own unit.
struct Summary {
    double median = 0; ///< of the rounds' medians, where there are rounds
    double p05 = 0;    ///< 5th percentile
    double p95 = 0;    ///< 95th percentile
    double mad = 0;    ///< median of the absolute deviations from the median, not scaled
    std::size_t n = 0;
    std::vector<double> samples; ///< as given, in order
    std::vector<double> rounds;  ///< median of each round; empty: measured in one go
    Interval ci95;               ///< of the median, from the rounds
};

/// Refuses an empty list and one with a NaN or infinity in it (`Failure::internal`).
CATOPTRIC_API Summary summarise(std::span<const double> samples);
/// The same for what was measured in rounds, each with at least one sample.
CATOPTRIC_API Summary summarise(std::span<const std::vector<double>> rounds);

/// The value below which `fraction` (0..1) of the values lie, linear between the two nearest ranks:
/// position fraction * (n - 1) of the sorted list. Refuses an empty list. Costs O(n).
CATOPTRIC_API double percentile(std::vector<double> values, double fraction);

} // namespace catoptric::measure
