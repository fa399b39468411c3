#include "measure/budget.hpp"

#include "measure/judge.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

/// Returns the row with the least value, or null if there are no rows.
template <typename Value>
const Row* find_row_minimising_value(const std::vector<const Row*>& rows, Value&& value) {
    const auto least = std::ranges::min_element(rows, {},
                                                [&](const Row* row) { return value(*row); });
    return least == rows.end() ? nullptr : *least;
}

double mean_flip_over_mirrors(const Row& row) { return row.error.flip; }
double rmse_over_mirrors(const Row& row) { return row.error.rmse; }
double median_frame_ms(const Row& row) { return row.time_ms().median; }

} // namespace

bool has_error_budget(const Comparison& comparison) {
    return !std::isnan(comparison.max_flip) || !std::isnan(comparison.max_rmse);
}

bool has_budget(const Comparison& comparison) {
    return !std::isnan(comparison.max_ms) || has_error_budget(comparison);
}

Order compare_to_time_budget(const Comparison& comparison, const Row& row) {
    if (std::isnan(comparison.max_ms)) return Order::less;
    const SampleSummary& time = row.time_ms();
    // A predicted time without a range has no stated interval, but rounds that are all equal.
    return compare_to_limit(time.ci95.is_known() ? time.ci95
                                                 : median_confidence_interval(time.rounds),
                            comparison.max_ms);
}

bool is_within_error_budget(const Comparison& comparison, const Row& row) {
    return (std::isnan(comparison.max_flip) || row.error.flip <= comparison.max_flip) &&
           (std::isnan(comparison.max_rmse) || row.error.rmse <= comparison.max_rmse);
}

BestRowsWithinBudget find_best_rows_within_budget(const Comparison& comparison) {
    std::vector<const Row*> judged, in_time, fitting;
    BestRowsWithinBudget answer;
    for (const Row& row : comparison.rows) {
        if (!is_judged_row(row)) continue;
        judged.push_back(&row);
        const Order time = compare_to_time_budget(comparison, row);
        const bool is_in_time = time == Order::less || time == Order::equal,
                   is_close = is_within_error_budget(comparison, row);
        if (is_in_time) in_time.push_back(&row);
        if (is_in_time && is_close) fitting.push_back(&row);
        if (time == Order::unknown && is_close) answer.undecided.push_back(&row);
    }
    const bool by_flip = !has_error_budget(comparison);
    answer.row = by_flip ? find_row_minimising_value(fitting, mean_flip_over_mirrors)
                         : find_row_minimising_value(fitting, median_frame_ms);
    if (answer.row == nullptr) {
        const bool by_rmse = std::isnan(comparison.max_flip) && !std::isnan(comparison.max_rmse);
        answer.nearest = in_time.empty() ? find_row_minimising_value(judged, median_frame_ms)
                         : by_rmse       ? find_row_minimising_value(in_time, rmse_over_mirrors)
                                   : find_row_minimising_value(in_time, mean_flip_over_mirrors);
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
