#pragma once

#include "measure/metric.hpp"

#include <string_view>

// What errors over several views (Row::views) say of a row, and of two.
namespace catoptric::measure {

/// A figure over the views in which it is defined: those whose mask has a finite pixel.
struct OverViews {
    double median = Difference::kNone;
    Interval ci95;
    std::vector<double> values; ///< of every view, in their order; NaN where it is not defined
};

/// `figure`: one of a difference that is a number.
OverViews over_views(const Row& row, const RowMask& mask, const Metric& figure);
/// Whether a figure of differences is one number, so that it has a median.
bool is_number(const Metric& figure);

/// 95 % interval of the median of what `a`'s figure over the mirrors ("flip", "off", "mae") is
/// more than `b`'s, view by view; views that say nothing of one of them are left out of both.
/// Throws `internal` for a name of no such figure.
Interval difference_over_views(const Row& a, const Row& b, std::string_view figure);

/// Whether a figure of `a` over the mirrors is less than `b`'s: the interval of their difference
/// over the views lies below 0. Not drawn over views: whether the figures are known and it is.
/// Fewer views than kFewest say nothing.
bool is_less(const Row& a, const Row& b, std::string_view figure);
/// One is less than the other; otherwise they tie.
bool apart(const Row& a, const Row& b, std::string_view figure);

/// Rows in order of a figure over the mirrors that is better the less it is, and those that tie.
struct Order {
    using Pairs = std::vector<std::pair<const Row*, const Row*>>; ///< as they stand in `rows`
    const Metric* figure;
    /// Without the reference and failed rows: first what is less than more others than are less
    /// than it, view by view; of equals the one with the lesser median.
    std::vector<const Row*> rows;
    Pairs ties;
    Pairs reversed; ///< the second is less than the first: no order fits all pairs
};
/// By FLIP, share off and MAE; none where no views were drawn, or fewer than two rows.
std::vector<Order> orders_over_views(const Comparison& comparison);

} // namespace catoptric::measure
