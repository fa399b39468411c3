#pragma once

#include "../core/export.hpp"

#include <cmath>
#include <limits>
#include <span>

/// How far a figure that was measured several times can be believed, whatever its distribution.
namespace catoptric::measure {

/// Fewer values than this bound no median with 95 % confidence.
inline constexpr std::size_t kFewest = 6;

/// From `low` to `high`, both included. Both NaN: not known.
struct Interval {
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();

    bool is_known() const { return !std::isnan(low) && !std::isnan(high); }
};

/// Of the median that the values are drawn around, with at least 95 % confidence if they are
/// independent: the k-th smallest to the k-th largest with the largest k for which
/// P(Binomial(n, 1/2) < k) <= 2.5 % (David and Nagaraja, Order Statistics, 7.1). 6 to 8 values:
/// their range (96.9 % for 6). Unknown for fewer than `kFewest` and where one is NaN. Costs
/// O(n log n).
CATOPTRIC_API Interval median_interval(std::span<const double> values);

/// Of the ratio a[i]/b[i], pair by pair, and of the difference a[i]-b[i]. Lists of different
/// lengths: only as many pairs as the shorter one has.
CATOPTRIC_API Interval ratio_interval(std::span<const double> a, std::span<const double> b);
CATOPTRIC_API Interval difference_interval(std::span<const double> a, std::span<const double> b);

} // namespace catoptric::measure
