#include "measure/views.hpp"

#include "core/error.hpp"
#include "measure/judge.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

constexpr std::string_view kOrdering[] = {"flip", "off", "mae"};

const RowMask& mirrors_mask() { return masks().front(); }

const Quantity& figure_of(std::string_view name) {
    const std::vector<Quantity>& figures = difference_quantities();
    const auto found = std::ranges::find(figures, name, &Quantity::name);
    check(found != figures.end() && is_number(*found), Failure::internal, "'", name,
          "': wanted a figure of a difference that is a number");
    return *found;
}

double number_of(const Quantity& figure, const Difference& error) {
    const Value value = value_of(figure, error);
    const auto* number = std::get_if<double>(&value);
    return number != nullptr ? *number : Difference::kNone;
}

double median_of(std::vector<double> values) {
    return values.empty() ? Difference::kNone : percentile(std::move(values), .5);
}

} // namespace

bool is_number(const Quantity& figure) {
    return figure.mask == "each" && std::holds_alternative<double>(value_of(figure, Difference{}));
}

OverViews over_views(const Row& row, const RowMask& mask, const Quantity& figure) {
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
    const Quantity& quantity = figure_of(figure);
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

bool apart(const Row& a, const Row& b, std::string_view figure) {
    if (!a.views.empty() || !b.views.empty())
        return difference_over_views(a, b, figure).excludes(0);
    const Quantity& quantity = figure_of(figure);
    const double in_a = number_of(quantity, a.error), in_b = number_of(quantity, b.error);
    return in_a < in_b || in_b < in_a; // neither where one is not known
}

std::vector<Order> orders_over_views(const Comparison& comparison) {
    std::vector<Order> orders;
    if (comparison.views.empty()) return orders;
    for (const std::string_view name : kOrdering) {
        Order order{&figure_of(name), {}, {}};
        std::vector<std::pair<double, const Row*>> rows;
        for (const Row& row : comparison.rows) {
            const double median = over_views(row, mirrors_mask(), *order.figure).median;
            if (!row.is_reference && !failed(row) && std::isfinite(median))
                rows.emplace_back(median, &row);
        }
        if (rows.size() < 2) return {};
        std::ranges::stable_sort(rows, {}, [](const auto& row) { return row.first; });
        for (std::size_t i = 0; i < rows.size(); ++i) {
            order.rows.push_back(rows[i].second);
            for (std::size_t k = i + 1; k < rows.size(); ++k)
                if (!apart(*rows[i].second, *rows[k].second, name))
                    order.ties.emplace_back(rows[i].second, rows[k].second);
        }
        orders.push_back(std::move(order));
    }
    return orders;
}

} // namespace catoptric::measure
