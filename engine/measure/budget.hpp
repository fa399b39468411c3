#pragma once

#include "measure/comparison.hpp"

#include <vector>

// Functions that find the best row for a user with a limited time per frame, or with a limit of
// error.
namespace catoptric::measure {

bool has_time_or_flip_budget(const Comparison& comparison);

/// Returns whether the row's time is within Comparison::max_ms with 95 % confidence: the upper end
/// of its interval, or its median if the interval is unknown. True without such a budget.
bool is_within_time_budget(const Comparison& comparison, const Row& row);
/// Returns whether the row's FLIP over the mirrors is at most Comparison::max_flip.
bool is_within_flip_budget(const Comparison& comparison, const Row& row);

/// Answer to a budget of time or error. Rows that take no part in fastest, closest and front are
/// left out.
struct BestRowsWithinBudget {
    /// The row to choose. With a budget of time alone, it has the least FLIP of the rows within the
    /// budget, and otherwise the least median time. Null if no row keeps the budgets.
    const Row* row = nullptr;
    /// Other rows within the budgets that tie with `row`.
    std::vector<const Row*> ties;
    /// Rows within the budget of FLIP whose median time is below the budget of time, but not with
    /// 95 % confidence.
    std::vector<const Row*> undecided;
    /// If no row keeps the budgets: the row with the least FLIP within the budget of time, or else
    /// the fastest row. Null if no row could be judged.
    const Row* nearest = nullptr;
};
BestRowsWithinBudget find_best_rows_within_budget(const Comparison& comparison);

} // namespace catoptric::measure
