#include "measure/budget.hpp"

#include "measure/judge.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

/// Returns the row with the least value, or null if there are no rows.
template <typename Value>
const Row* find_least(const std::vector<const Row*>& rows, Value&& value) {
    const auto least = std::ranges::min_element(rows, {},
                                                [&](const Row* row) { return value(*row); });
    return least == rows.end() ? nullptr : *least;
}

double mirror_flip(const Row& row) { return row.error.flip; }
double mirror_rmse(const Row& row) { return row.error.rmse; }
double median_ms(const Row& row) { return row.time_ms().median; }

} // namespace

bool has_error_budget(const Comparison& comparison) {
    return !std::isnan(comparison.max_flip) || !std::isnan(comparison.max_rmse);
}

bool has_budget(const Comparison& comparison) {
    return !std::isnan(comparison.max_ms) || has_error_budget(comparison);
}

Order compare_to_budget(const Comparison& comparison, const Row& row) {
    if (std::isnan(comparison.max_ms)) return Order::less;
    const SampleSummary& time = row.time_ms();
    // A predicted time without a range has no stated interval, but rounds that are all equal.
    return compare_to_limit(time.ci95.is_known() ? time.ci95 : median_interval(time.rounds),
                            comparison.max_ms);
}

bool keeps_error_budget(const Comparison& comparison, const Row& row) {
    return (std::isnan(comparison.max_flip) || row.error.flip <= comparison.max_flip) &&
           (std::isnan(comparison.max_rmse) || row.error.rmse <= comparison.max_rmse);
}

BestRows find_best_rows(const Comparison& comparison) {
    std::vector<const Row*> judged, in_time, fitting;
    BestRows answer;
    for (const Row& row : comparison.rows) {
        if (!is_judged(row)) continue;
        judged.push_back(&row);
        const Order time = compare_to_budget(comparison, row);
        const bool is_in_time = time == Order::less || time == Order::equal,
                   is_close = keeps_error_budget(comparison, row);
        if (is_in_time) in_time.push_back(&row);
        if (is_in_time && is_close) fitting.push_back(&row);
        if (time == Order::unknown && is_close) answer.undecided.push_back(&row);
    }
    const bool by_flip = !has_error_budget(comparison);
    answer.row = by_flip ? find_least(fitting, mirror_flip) : find_least(fitting, median_ms);
    if (answer.row == nullptr) {
        const bool by_rmse = std::isnan(comparison.max_flip) && !std::isnan(comparison.max_rmse);
        answer.nearest = in_time.empty() ? find_least(judged, median_ms)
                         : by_rmse       ? find_least(in_time, mirror_rmse)
                                         : find_least(in_time, mirror_flip);
        return answer;
    }
    const RowJudge judge(comparison.rows);
    for (const Row* row : fitting) {
        if (row == answer.row) continue;
        const Order order = by_flip ? judge.flip(*answer.row, *row)
                                    : judge.times(*answer.row, *row);
        if (order == Order::equal) answer.equal.push_back(row);
        if (order == Order::unknown) answer.open.push_back(row);
    }
    return answer;
}

} // namespace catoptric::measure
