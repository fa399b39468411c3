// Writes the sentence that names the best row within a budget of time or error.
#include "measure/budget.hpp"
#include "measure/interval.hpp"

#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

using measure::Order;

std::string format_row(const Row& row) {
    const measure::SampleSummary& time = row.time_ms();
    std::string interval;
    if (time.ci95.is_known())
        interval = fmt::format(" [{} - {}]", format_ms(time.ci95.low), format_ms(time.ci95.high));
    return fmt::format("{} ({} ms{}, FLIP {})", row.label, format_ms(time.median), interval,
                       format_flip(row.error));
}

bool lacks_interval(const Row* row) { return !row->time_ms().ci95.is_known(); }

std::string format_rows(const std::vector<const Row*>& rows) {
    std::vector<std::string> texts;
    for (const Row* row : rows) texts.push_back(format_row(*row));
    return join_texts(texts, "; ");
}

/// Returns the limits, such as "4 ms and FLIP 0.1".
std::string format_budget_limits(const Comparison& comparison) {
    std::vector<std::string> limits;
    if (!std::isnan(comparison.max_ms)) limits.push_back(fmt::format("{:g} ms", comparison.max_ms));
    if (!std::isnan(comparison.max_flip))
        limits.push_back(fmt::format("FLIP {:g}", comparison.max_flip));
    if (!std::isnan(comparison.max_rmse))
        limits.push_back(fmt::format("rmse {:g}", comparison.max_rmse));
    return join_texts(limits, " and ");
}

} // namespace

std::string describe_budget(const Comparison& comparison) {
    if (!measure::has_budget(comparison)) return "";
    const measure::BestRows answer = measure::find_best_rows(comparison);
    const std::string where = format_budget_limits(comparison) + " on " + comparison.device.name +
                              describe_judged_time(comparison);
    const bool by_time = measure::has_error_budget(comparison);
    const char* least = by_time ? "time" : "FLIP";
    std::string text;
    if (answer.row != nullptr && answer.open.empty()) {
        text = fmt::format("Within {}: {} has the least {}", where, format_row(*answer.row), least);
        if (!answer.equal.empty())
            text += fmt::format(". Equal {}: {}", least, format_rows(answer.equal));
    } else if (answer.row != nullptr) {
        std::vector<const Row*> rows{answer.row};
        rows.insert(rows.end(), answer.equal.begin(), answer.equal.end());
        rows.insert(rows.end(), answer.open.begin(), answer.open.end());
        text = fmt::format("Within {}: cannot tell which of {} rows has the least {}: {}", where,
                           rows.size(), least, format_rows(rows));
        if (std::ranges::any_of(rows, lacks_interval))
            text += fmt::format(". Times have no interval after {} frames: wanted --frames {} or "
                                "more",
                                comparison.frames, measure::kMinIntervalSamples);
    } else if (answer.nearest == nullptr) {
        return fmt::format("Within {}: no row could be judged.", where);
    } else if (!answer.undecided.empty()) {
        text = fmt::format("Cannot tell whether a row keeps {}", where);
    } else {
        const bool is_in_time = measure::compare_to_budget(comparison, *answer.nearest) ==
                                Order::less;
        text = fmt::format("No row keeps {}. The {} is {}", where,
                           !is_in_time || !by_time         ? "row with the least median time"
                           : std::isnan(comparison.max_ms) ? "closest row"
                                                           : "closest row within the time",
                           format_row(*answer.nearest));
    }
    if (!answer.undecided.empty())
        text += ". The interval of the time holds the limit, or is not known: " +
                format_rows(answer.undecided);
    return text + ".";
}

} // namespace catoptric::report
