#include "measure/views.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/judge.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

constexpr std::string_view kOrdering[] = {"flip", "off", "mae"};

const RowMask& mirrors_mask() { return masks().front(); }

const Metric& figure_of(std::string_view name) {
    const std::vector<Metric>& figures = difference_metrics();
    const auto found = std::ranges::find(figures, name, &Metric::name);
    check(found != figures.end() && is_number(*found), Failure::internal, "'", name,
          "': wanted a figure of a difference that is a number");
    return *found;
}

double number_of(const Metric& figure, const Difference& error) {
    const Value value = value_of(figure, error);
    const auto* number = std::get_if<double>(&value);
    return number != nullptr ? *number : Difference::kNone;
}

double median_of(std::vector<double> values) {
    return values.empty() ? Difference::kNone : percentile(std::move(values), .5);
}

/// Returns the row's score in one figure, such as FLIP: the number of rows that have a larger value
/// than this row, minus the number of rows that have a smaller value.
int standing_of(const Row& row, const std::vector<const Row*>& rows, std::string_view figure) {
    int standing = 0;
    for (const Row* other : rows)
        standing += is_less(row, *other, figure) - is_less(*other, row, figure);
    return standing;
}

Order order_by(std::string_view name, const std::vector<const Row*>& rows) {
    Order order{&figure_of(name), rows, {}, {}};
    std::ranges::stable_sort(order.rows, {}, [&](const Row* row) {
        const double median = over_views(*row, mirrors_mask(), *order.figure).median;
        return std::pair(-standing_of(*row, rows, name), std::isnan(median) ? INFINITY : median);
    });
    for (std::size_t i = 0; i < order.rows.size(); ++i)
        for (std::size_t k = i + 1; k < order.rows.size(); ++k) {
            const Row &first = *order.rows[i], &second = *order.rows[k];
            if (!apart(first, second, name)) order.ties.emplace_back(&first, &second);
            if (is_less(second, first, name)) order.reversed.emplace_back(&first, &second);
        }
    return order;
}

} // namespace

bool is_number(const Metric& figure) {
    return figure.mask == "each" && std::holds_alternative<double>(value_of(figure, Difference{}));
}

OverViews over_views(const Row& row, const RowMask& mask, const Metric& figure) {
    OverViews over;
    for (const Errors& errors : row.views)
        over.values.push_back(number_of(figure, errors.*mask.error));
    std::vector<double> known = over.values;
    std::erase_if(known, [](double value) { return !std::isfinite(value); });
    over.ci95 = median_interval(known);
    over.median = median_of(std::move(known));
    return over;
}

Interval difference_over_views(const Row& a, const Row& b, std::string_view figure) {
    const Metric& quantity = figure_of(figure);
    std::vector<double> of_a, of_b;
    for (std::size_t i = 0; i < std::min(a.views.size(), b.views.size()); ++i) {
        const double in_a = number_of(quantity, a.views[i].error),
                     in_b = number_of(quantity, b.views[i].error);
        if (!std::isfinite(in_a) || !std::isfinite(in_b)) continue;
        of_a.push_back(in_a);
        of_b.push_back(in_b);
    }
    return difference_interval(of_a, of_b);
}

bool is_less(const Row& a, const Row& b, std::string_view figure) {
    if (!a.views.empty() || !b.views.empty())
        // False if the interval is not known.
        return difference_over_views(a, b, figure).high < 0;
    const Metric& quantity = figure_of(figure);
    return number_of(quantity, a.error) < number_of(quantity, b.error);
}

bool apart(const Row& a, const Row& b, std::string_view figure) {
    return is_less(a, b, figure) || is_less(b, a, figure);
}

std::vector<Order> orders_over_views(const Comparison& comparison) {
    std::vector<const Row*> rows;
    for (const Row& row : comparison.rows)
        if (!row.is_reference && !failed(row) && !row.views.empty()) rows.push_back(&row);
    std::vector<Order> orders;
    if (rows.size() > 1)
        for (const std::string_view name : kOrdering) orders.push_back(order_by(name, rows));
    return orders;
}

} // namespace catoptric::measure
