#pragma once

#include "measure/metric.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

// Evaluation of errors over several drawn views (Row::views), for one row and for pairs of rows.
namespace catoptric::measure {

/// View in which a row has its largest FLIP over the mirrors.
struct WorstView {
    std::size_t view = 0; ///< index of the view in Comparison::views
    Picture display;      ///< the row's picture, with the reference to its right
};

/// Metric over the views in which it is defined: those whose mask has a finite pixel.
struct MetricOverViews {
    double median = Difference::kNone;
    Interval ci95;
    std::vector<double> values; ///< value in each view, in order; NaN where it is not defined
};

/// Returns a metric of a row over its views. `metric` must be a metric of a difference that is one
/// number.
MetricOverViews metric_over_views(const Row& row, const RowMask& mask, const Metric& metric);

/// How much a metric tells over views of which several share an instant. Such views resemble each
/// other, so their mean is less certain than that of as many views with an instant each.
struct SharedInstants {
    std::size_t instants = 0;
    /// Ratio of the variance of the mean to that of equally many independent views: 1 + (m - 1)
    /// rho, at least 1. `rho` is the correlation between views of one instant. `m` is the mean over
    /// all views of the number of views at that view's instant (Kish, Survey Sampling, 1965).
    double design_effect = 1;
    double effective_views = 0; ///< number of views divided by the design effect
};
/// Returns the effect of shared instants on a metric with one value a view; NaN: not defined there.
/// Returns nothing if no two neighbouring views share an instant, or if fewer than two instants
/// have values, as in a still scene. `rho` is estimated by the analysis of variance. With fewer
/// than about six instants the estimate of the effective views is far too large.
std::optional<SharedInstants> estimate_shared_instants(const std::vector<View>& views,
                                                       std::span<const double> values);

/// Returns whether the value of a metric is one number. Only such metrics have a median over views.
bool is_scalar(const Metric& metric);

/// Returns the 95 % interval of the median of a's metric minus b's, over the mirrors, view by view.
/// `figure` is a name such as "flip", "off" or "mae". Views in which either is not finite are left
/// out. FLIP differences below the noise of the reference count as 0. Throws `internal` if no
/// metric of differences that is a number has this name.
Interval metric_difference_interval(const Row& a, const Row& b, std::string_view figure);

/// Returns whether a metric of `a` over the mirrors is less than that of `b`: the interval of their
/// difference over the views lies below 0. Without drawn views, the metrics of the picture are
/// compared, and FLIP must differ by more than the noise of the reference. Fewer views than
/// kMinIntervalSamples give false.
bool is_metric_less(const Row& a, const Row& b, std::string_view figure);
/// Returns whether the metrics of two rows differ over the views with 95 % confidence. Otherwise
/// the rows tie.
bool rows_differ(const Row& a, const Row& b, std::string_view figure);

/// Rows in order of a metric over the mirrors for which less is better, with the pairs that tie.
struct RowOrder {
    /// Pairs of rows that tie, in the order of `rows`.
    using RowPairs = std::vector<std::pair<const Row*, const Row*>>;
    const Metric* metric;
    /// All rows except the reference and failed rows. A row's score in the metric is the number of
    /// rows with larger values minus the number of rows with smaller values, over the views. Rows
    /// with a larger score come first, and between equal scores the row with the smaller median.
    std::vector<const Row*> rows;
    RowPairs ties;
    RowPairs reversed; ///< pairs whose second row is less than the first: no order fits all pairs
};
/// Returns the orders by FLIP, share off and MAE. Empty if no views were drawn or fewer than two
/// rows have views.
std::vector<RowOrder> order_rows(const Comparison& comparison);

} // namespace catoptric::measure
