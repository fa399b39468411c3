#pragma once

#include "measure/comparison.hpp"
#include "measure/interval.hpp"

#include <vector>

// Functions that find the best row for a user with a limited time per frame, or with a limit of
// error.
namespace catoptric::measure {

bool has_budget(const Comparison& comparison);
/// Returns whether there is a limit of FLIP or rmse.
bool has_error_budget(const Comparison& comparison);

/// Returns whether the row's time is less than Comparison::max_ms, or more, by the whole 95 %
/// interval of its median. `unknown` if the interval contains the limit or is not known. `less`
/// without such a budget.
Order compare_to_budget(const Comparison& comparison, const Row& row);
/// Returns whether FLIP and rmse over the mirrors are at most Comparison::max_flip and max_rmse.
bool keeps_error_budget(const Comparison& comparison, const Row& row);

/// Answer to a budget of time or error. Only judged rows take part (is_judged).
struct BestRows {
    /// The row to choose. With a budget of time alone, it has the least FLIP of the rows within the
    /// budget, and otherwise the least median time. Null if no row keeps the budgets.
    const Row* row = nullptr;
    /// Other rows within the budgets whose time (or FLIP, with a budget of time alone) is equal to
    /// that of `row`, and those of which it cannot be told whether theirs is less.
    std::vector<const Row*> equal, open;
    /// Rows within the budget of error of which it cannot be told whether they keep that of time.
    std::vector<const Row*> undecided;
    /// If no row keeps the budgets: the row with the least error within the budget of time, or else
    /// the row with the least median time. The error is rmse if only it is limited, else FLIP. Null
    /// if no row could be judged.
    const Row* nearest = nullptr;
};
BestRows find_best_rows(const Comparison& comparison);

} // namespace catoptric::measure
