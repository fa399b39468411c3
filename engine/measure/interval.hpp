#pragma once

#include "measure/comparison.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

// Functions for confidence intervals of repeated measurements, valid for any distribution.
namespace catoptric::measure {

/// Smallest number of values for which the median has a 95 % confidence interval.
inline constexpr std::size_t kMinIntervalSamples = 6;

/// Returns an interval that contains the median of the underlying distribution with at least 95 %
/// confidence, if the values are independent. The interval runs from the k-th smallest to the k-th
/// largest value. k is the largest rank for which P(Binomial(n, 1/2) < k) <= 2.5 % (David and
/// Nagaraja, Order Statistics, 7.1). For 6 to 8 values it is their range (96.9 % for 6). It is
/// unknown for fewer than `kMinIntervalSamples` values or if a value is NaN. Costs O(n log n).
Interval median_interval(std::span<const double> values);

/// How a measured value stands to another value or to a limit.
enum class Order : std::uint8_t { less, equal, more, unknown };

/// Returns where the whole interval lies: below the limit, above it, or on it. `unknown` if the
/// interval contains the limit and other values, or if it is not known. All verdicts on times use
/// this rule.
Order compare_to_limit(const Interval& interval, double limit);

/// Return the interval of the median of a[i]/b[i], and of a[i]-b[i]. If the lists differ in length,
/// only as many pairs count as the shorter list has.
Interval median_ratio_interval(std::span<const double> a, std::span<const double> b);
Interval median_difference_interval(std::span<const double> a, std::span<const double> b);

/// A median, or a ratio of medians, and its 95 % confidence interval.
struct MedianWithInterval {
    double median;
    Interval ci95;
};

/// Returns the ratio a/b of two independent medians. Its interval combines both intervals by the
/// method of variance estimates recovery, in logarithms (Zou and Donner, Construction of confidence
/// limits about effect measures, 2008): its distances to the ratio are the roots of the sums of
/// squares. The interval is unknown unless both intervals are known and positive.
MedianWithInterval ratio_of_medians(const MedianWithInterval& a, const MedianWithInterval& b);

} // namespace catoptric::measure
