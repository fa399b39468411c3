#include "measure/views.hpp"

#include "core/error.hpp"
#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptric::measure {

namespace {

constexpr std::string_view kRowOrderingMetrics[] = {"flip", "off", "mae"};

const RowMask& find_mirror_mask() { return row_masks().front(); }

const Metric& find_metric(std::string_view name) {
    const std::vector<Metric>& figures = difference_metrics();
    const auto found = std::ranges::find(figures, name, &Metric::name);
    check(found != figures.end() && is_scalar(*found), Failure::internal, "'", name,
          "': wanted a figure of a difference that is a number");
    return *found;
}

double scalar_value(const Metric& metric, const Difference& error) {
    const MetricValue value = metric_value(metric, error);
    const auto* number = std::get_if<double>(&value);
    return number != nullptr ? *number : Difference::kNone;
}

/// Returns the difference of two errors below which they cannot be told apart.
double find_noise_floor(const Metric& metric, const Difference& a, const Difference& b) {
    return metric.name == "flip" ? flip_noise_floor(a, b) : 0;
}

double median_of(std::vector<double> values) {
    return values.empty() ? Difference::kNone : percentile(std::move(values), .5);
}

/// Returns the row's score in one figure, such as FLIP: the number of rows that have a larger value
/// than this row, minus the number of rows that have a smaller value.
int ranking_score(const Row& row, const std::vector<const Row*>& rows, std::string_view figure) {
    int standing = 0;
    for (const Row* other : rows)
        standing += is_metric_less(row, *other, figure) - is_metric_less(*other, row, figure);
    return standing;
}

RowOrder order_by_metric(std::string_view name, const std::vector<const Row*>& rows) {
    RowOrder order{&find_metric(name), rows, {}, {}};
    std::ranges::stable_sort(order.rows, {}, [&](const Row* row) {
        const double median = metric_over_views(*row, find_mirror_mask(), *order.metric).median;
        return std::pair(-ranking_score(*row, rows, name), std::isnan(median) ? INFINITY : median);
    });
    for (std::size_t i = 0; i < order.rows.size(); ++i)
        for (std::size_t k = i + 1; k < order.rows.size(); ++k) {
            const Row &first = *order.rows[i], &second = *order.rows[k];
            if (!rows_differ(first, second, name)) order.ties.emplace_back(&first, &second);
            if (is_metric_less(second, first, name)) order.reversed.emplace_back(&first, &second);
        }
    return order;
}

} // namespace

bool is_scalar(const Metric& metric) {
    return metric.mask == "each" &&
           std::holds_alternative<double>(metric_value(metric, Difference{}));
}

MetricOverViews metric_over_views(const Row& row, const RowMask& mask, const Metric& metric) {
    MetricOverViews over;
    for (const Errors& errors : row.views)
        over.values.push_back(scalar_value(metric, errors.*mask.error));
    std::vector<double> known = over.values;
    std::erase_if(known, [](double value) { return !std::isfinite(value); });
    over.ci95 = median_interval(known);
    over.median = median_of(std::move(known));
    return over;
}

std::optional<SharedInstants> estimate_shared_instants(const std::vector<View>& views,
                                                       std::span<const double> values) {
    std::vector<std::vector<double>> instants;
    std::size_t largest = 0;
    for (std::size_t i = 0; i < std::min(views.size(), values.size()); ++i) {
        if (i == 0 || views[i].time != views[i - 1].time) instants.emplace_back();
        if (std::isfinite(values[i])) instants.back().push_back(values[i]);
        largest = std::max(largest, instants.back().size());
    }
    std::erase_if(instants, &std::vector<double>::empty);
    if (largest < 2 || instants.size() < 2) return {};
    const auto mean_of = [](const std::vector<double>& of) {
        return std::accumulate(of.begin(), of.end(), 0.) / static_cast<double>(of.size());
    };
    double count = 0, squared_sizes = 0, sum = 0;
    for (const std::vector<double>& instant : instants) {
        const auto size = static_cast<double>(instant.size());
        count += size, squared_sizes += size * size, sum += size * mean_of(instant);
    }
    const auto square = [](double value) { return value * value; };
    double between = 0, within = 0; // sums of squares
    for (const std::vector<double>& instant : instants) {
        const double mean = mean_of(instant);
        between += static_cast<double>(instant.size()) * square(mean - sum / count);
        for (const double value : instant) within += square(value - mean);
    }
    const auto groups = static_cast<double>(instants.size());
    between /= groups - 1, within /= count - groups;
    const double size = (count - squared_sizes / count) / (groups - 1);
    const double total = between + (size - 1) * within;
    const double rho = total > 0 ? std::max((between - within) / total, 0.) : 0;
    const double effect = 1 + (squared_sizes / count - 1) * rho;
    return SharedInstants{instants.size(), effect, count / effect};
}

Interval metric_difference_interval(const Row& a, const Row& b, std::string_view figure) {
    const Metric& metric = find_metric(figure);
    std::vector<double> of_a, of_b;
    for (std::size_t i = 0; i < std::min(a.views.size(), b.views.size()); ++i) {
        const double in_a = scalar_value(metric, a.views[i].error),
                     in_b = scalar_value(metric, b.views[i].error);
        if (!std::isfinite(in_a) || !std::isfinite(in_b)) continue;
        const bool is_noise = std::abs(in_a - in_b) <
                              find_noise_floor(metric, a.views[i].error, b.views[i].error);
        of_a.push_back(is_noise ? in_b : in_a);
        of_b.push_back(in_b);
    }
    return median_difference_interval(of_a, of_b);
}

bool is_metric_less(const Row& a, const Row& b, std::string_view figure) {
    if (!a.views.empty() || !b.views.empty())
        // False if the interval is not known.
        return metric_difference_interval(a, b, figure).high < 0;
    const Metric& metric = find_metric(figure);
    return scalar_value(metric, a.error) + find_noise_floor(metric, a.error, b.error) <
           scalar_value(metric, b.error);
}

bool rows_differ(const Row& a, const Row& b, std::string_view figure) {
    return is_metric_less(a, b, figure) || is_metric_less(b, a, figure);
}

std::vector<RowOrder> order_rows(const Comparison& comparison) {
    std::vector<const Row*> rows;
    for (const Row& row : comparison.rows)
        if (!row.is_reference && !has_nonfinite_pixels(row) && !row.views.empty())
            rows.push_back(&row);
    std::vector<RowOrder> orders;
    if (rows.size() > 1)
        for (const std::string_view name : kRowOrderingMetrics)
            orders.push_back(order_by_metric(name, rows));
    return orders;
}

} // namespace catoptric::measure
