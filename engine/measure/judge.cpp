#include "measure/judge.hpp"

#include "measure/halves.hpp"
#include "measure/interval.hpp"
#include "measure/metric.hpp"
#include "measure/rows.hpp"
#include "measure/views.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

/// Returns the first row on the front that beats this row, or null if none does.
const Row* find_row_dominating(const std::vector<const Row*>& front, const Row& loser) {
    const auto found = std::ranges::find_if(front,
                                            [&](const Row* row) { return beats_row(*row, loser); });
    return found == front.end() ? nullptr : *found;
}

const RegisteredMetric kFailedRowMetric{
    {.name = "failed",
     .help =
         "whether the row's picture has pixels that are NaN or infinite; no figure of such a row "
         "is judged",
     .order = 200,
     .only_where_true = true,
     .get = [](const Row& row) -> MetricValue { return has_nonfinite_pixels(row); }}};

} // namespace

bool has_nonfinite_pixels(const Row& row) {
    return row.error.nonfinite > 0 || row.error_all.nonfinite > 0;
}

bool has_known_error(const Row* row) {
    return row != nullptr && !has_nonfinite_pixels(*row) && std::isfinite(row->error.rmse);
}

namespace {

/// Returns whether the row has the values that a choice needs: known FLIP and a time above 0.
bool has_time_and_flip(const Row& row) {
    return is_row_eligible_for_ranking(row) && !std::isnan(row.error.flip) &&
           row.time_ms().median > 0;
}

} // namespace

bool is_row_eligible_for_ranking(const Row& row) {
    return has_known_error(&row) && !row.mirrors_black;
}

bool has_known_time(const Row& row) { return !std::isnan(row.time_ms().median); }

Interval time_ratio_interval(const Row& a, const Row& b) {
    return median_ratio_interval(a.time_ms().rounds, b.time_ms().rounds);
}

bool is_confidently_faster(const Row& a, const Row& b) {
    return time_ratio_interval(a, b).high < 1;
}

bool is_time_tie(const Row& a, const Row& b) {
    return !is_confidently_faster(a, b) && !is_confidently_faster(b, a);
}

bool has_less_flip(const Row& a, const Row& b) { return is_metric_less(a, b, "flip"); }

bool beats_row(const Row& a, const Row& b) {
    if (!has_time_and_flip(a) || !has_time_and_flip(b)) return false;
    return (is_confidently_faster(a, b) && !has_less_flip(b, a)) ||
           (has_less_flip(a, b) && !is_confidently_faster(b, a));
}

std::vector<std::size_t> find_pareto_front_of_rows(const std::vector<Row>& rows) {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (has_time_and_flip(rows[i]) &&
            std::ranges::none_of(rows, [&](const Row& other) { return beats_row(other, rows[i]); }))
            front.push_back(i);
    std::ranges::stable_sort(front, {}, [&](std::size_t i) { return rows[i].time_ms().median; });
    return front;
}

TimeRankRange find_time_rank_range_of_row(const Comparison& comparison, const Row& row) {
    if (!has_known_time(row)) return {0, 0};
    TimeRankRange places{1, 0};
    for (const Row& other : comparison.rows) {
        if (!has_known_time(other)) continue;
        ++places.last;
        places.first += is_confidently_faster(other, row);
        places.last -= is_confidently_faster(row, other);
    }
    return places;
}

std::vector<const Row*> find_noisy_rows(const Comparison& comparison) {
    std::vector<const Row*> noisy;
    for (const Row& row : comparison.rows)
        if (row.noisy) noisy.push_back(&row);
    return noisy;
}

bool is_on_pareto_front(const Comparison& comparison, const Row& row) {
    return std::ranges::any_of(comparison.pareto, [&](std::size_t index) {
        return index < comparison.rows.size() && &comparison.rows[index] == &row;
    });
}

std::vector<const Row*> find_fastest_rows(const Comparison& comparison) {
    std::vector<const Row*> fastest;
    for (const Row& row : comparison.rows)
        if (is_row_eligible_for_ranking(row) && has_known_time(row) &&
            std::ranges::none_of(comparison.rows, [&](const Row& other) {
                return is_row_eligible_for_ranking(other) && is_confidently_faster(other, row);
            }))
            fastest.push_back(&row);
    return fastest;
}

const Row* find_closest_row(const Comparison& comparison) {
    const Row* closest = nullptr;
    for (const Row& row : comparison.rows) {
        if (row.is_reference || !is_row_eligible_for_ranking(row)) continue;
        if (closest == nullptr || row.error.flip < closest->error.flip) closest = &row;
    }
    return closest;
}

std::vector<const Row*> find_ties_with_closest_row(const Comparison& comparison) {
    std::vector<const Row*> ties;
    const Row* closest = find_closest_row(comparison);
    for (const Row& row : comparison.rows) {
        if (closest == nullptr || &row == closest || row.is_reference ||
            !is_row_eligible_for_ranking(row))
            continue;
        if (row.error.flip - closest->error.flip < find_flip_noise_floor(row.error, closest->error))
            ties.push_back(&row);
    }
    return ties;
}

RowRanking rank_rows(const Comparison& comparison) {
    RowRanking result;
    for (const std::size_t index : comparison.pareto)
        if (index < comparison.rows.size()) result.front.push_back(&comparison.rows[index]);
    for (const Row* winner : result.front) {
        RowRanking::RowWins win{winner, {}};
        for (const Row& row : comparison.rows)
            if (!is_on_pareto_front(comparison, row) &&
                find_row_dominating(result.front, row) == winner)
                win.losers.push_back(&row);
        if (!win.losers.empty()) result.wins.push_back(std::move(win));
    }
    for (const Row& row : comparison.rows) {
        if (!has_known_error(&row))
            result.not_judged.push_back(&row);
        else if (row.mirrors_black)
            result.black.push_back(&row);
        else if (!has_known_time(row))
            result.untimed.push_back(&row);
        else if (!is_on_pareto_front(comparison, row) &&
                 find_row_dominating(result.front, row) == nullptr)
            result.beaten_by_beaten.push_back(&row);
    }
    return result;
}

RayTracingVerdict find_ray_tracing_verdict(const Comparison& comparison) {
    RayTracingVerdict verdict;
    verdict.any_traced = std::ranges::any_of(comparison.rows, is_ray_traced_row);
    for (const Row& row : comparison.rows) {
        if (is_ray_traced_row(row) || !is_row_eligible_for_ranking(row) || !has_known_time(row))
            continue;
        ++verdict.others;
        if (std::ranges::none_of(comparison.rows, [&](const Row& other) {
                return is_ray_traced_row(other) && beats_row(other, row);
            }))
            verdict.unbeaten.push_back(&row);
    }
    return verdict;
}

} // namespace catoptric::measure
