#pragma once

#include "measure/comparison.hpp"

#include <vector>

// The row that a user should take who may spend a given time, or accept a given error.
namespace catoptric::measure {

bool has_time_or_flip_budget(const Comparison& comparison);

/// Returns whether the row's time is within Comparison::max_ms with 95 % confidence: the upper end
/// of its interval, or its median if the interval is unknown. True without such a budget.
bool is_within_time_budget(const Comparison& comparison, const Row& row);
/// Returns whether the row's FLIP over the mirrors is at most Comparison::max_flip.
bool is_within_flip_budget(const Comparison& comparison, const Row& row);

/// Answer to a budget. Only rows that take part in fastest, closest and front count.
struct BestRowsWithinBudget {
    /// Row that keeps the budgets. With a budget of time alone it has the least FLIP, else the
    /// least median time. Null if no row keeps them.
    const Row* row = nullptr;
    /// Other rows that keep the budgets and cannot be told from `row`.
    std::vector<const Row*> ties;
    /// Rows that keep the budget of FLIP, and whose median time is below that of time, but not with
    /// confidence.
    std::vector<const Row*> undecided;
    /// If no row keeps the budgets: the closest of the rows within the budget of time, or the
    /// fastest row if no row is. Null if no row could be judged.
    const Row* nearest = nullptr;
};
BestRowsWithinBudget find_best_rows_within_budget(const Comparison& comparison);

} // namespace catoptric::measure
