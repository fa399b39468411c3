#pragma once

#include "measure/quantity.hpp"

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
OverViews over_views(const Row& row, const RowMask& mask, const Quantity& figure);
/// Whether a figure of differences is one number, so that it has a median.
bool is_number(const Quantity& figure);

/// 95 % interval of the median of what `a`'s figure over the mirrors ("flip", "off", "mae") is
/// more than `b`'s, view by view; views that say nothing of one of them are left out of both.
/// Throws `internal` for a name of no such figure.
Interval difference_over_views(const Row& a, const Row& b, std::string_view figure);

/// Whether two rows differ in a figure over the mirrors: the interval of their difference over the
/// views excludes 0. Not drawn over views: whether the figures are known and differ at all. Fewer
/// views than kFewest tell nothing apart.
bool apart(const Row& a, const Row& b, std::string_view figure);

/// A figure over the mirrors by which rows are put in order, and those of them that tie.
struct Order {
    const Quantity* figure;
    std::vector<const Row*> rows; ///< least median first; without the reference and failed rows
    std::vector<std::pair<const Row*, const Row*>> ties; ///< not apart, the first before the second
};
/// By FLIP, share off and MAE; none where no views were drawn, or fewer than two rows.
std::vector<Order> orders_over_views(const Comparison& comparison);

} // namespace catoptric::measure
