#include "measure/judge.hpp"

#include "measure/interval.hpp"
#include "measure/metric.hpp"
#include "measure/rows.hpp"
#include "measure/views.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

/// Returns the first row on the front that beats this row, or null if none does.
const Row* winner_over(const std::vector<const Row*>& front, const Row& loser) {
    const auto found = std::ranges::find_if(front,
                                            [&](const Row* row) { return beats(*row, loser); });
    return found == front.end() ? nullptr : *found;
}

const Registered kFailed{
    {.name = "failed",
     .help =
         "whether the row's picture has pixels that are NaN or infinite; no figure of such a row "
         "is judged",
     .order = 200,
     .only_where_true = true,
     .get = [](const Row& row) -> Value { return failed(row); }}};

} // namespace

bool failed(const Row& row) { return row.error.nonfinite > 0 || row.error_all.nonfinite > 0; }

bool judged(const Row* row) {
    return row != nullptr && !failed(*row) && std::isfinite(row->error.rmse);
}

namespace {

/// Returns whether the row has the values that a choice needs: known FLIP and a time above 0.
bool is_choice(const Row& row) {
    return is_candidate(row) && !std::isnan(row.error.flip) && row.time_ms().median > 0;
}

} // namespace

bool is_candidate(const Row& row) { return judged(&row) && !row.mirrors_black; }

Interval time_ratio(const Row& a, const Row& b) {
    return ratio_interval(a.time_ms().rounds, b.time_ms().rounds);
}

bool is_faster(const Row& a, const Row& b) { return time_ratio(a, b).high < 1; }

bool is_tie(const Row& a, const Row& b) { return !is_faster(a, b) && !is_faster(b, a); }

bool is_closer(const Row& a, const Row& b) { return is_less(a, b, "flip"); }

bool beats(const Row& a, const Row& b) {
    if (!is_choice(a) || !is_choice(b)) return false;
    return (is_faster(a, b) && !is_closer(b, a)) || (is_closer(a, b) && !is_faster(b, a));
}

std::vector<std::size_t> front_of(const std::vector<Row>& rows) {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (is_choice(rows[i]) &&
            std::ranges::none_of(rows, [&](const Row& other) { return beats(other, rows[i]); }))
            front.push_back(i);
    std::ranges::stable_sort(front, {}, [&](std::size_t i) { return rows[i].time_ms().median; });
    return front;
}

PlaceRange places_in_time(const Comparison& comparison, const Row& row) {
    PlaceRange places{1, comparison.rows.size()};
    for (const Row& other : comparison.rows) {
        places.first += is_faster(other, row);
        places.last -= is_faster(row, other);
    }
    return places;
}

std::vector<const Row*> noisy_rows(const Comparison& comparison) {
    std::vector<const Row*> noisy;
    for (const Row& row : comparison.rows)
        if (row.noisy) noisy.push_back(&row);
    return noisy;
}

bool on_front(const Comparison& comparison, const Row& row) {
    return std::ranges::any_of(comparison.pareto, [&](std::size_t index) {
        return index < comparison.rows.size() && &comparison.rows[index] == &row;
    });
}

std::vector<const Row*> fastest_rows(const Comparison& comparison) {
    std::vector<const Row*> fastest;
    for (const Row& row : comparison.rows)
        if (is_candidate(row) && std::ranges::none_of(comparison.rows, [&](const Row& other) {
                return is_candidate(other) && is_faster(other, row);
            }))
            fastest.push_back(&row);
    return fastest;
}

const Row* closest_row(const Comparison& comparison) {
    const Row* closest = nullptr;
    for (const Row& row : comparison.rows) {
        if (row.is_reference || !is_candidate(row)) continue;
        if (closest == nullptr || row.error.flip < closest->error.flip) closest = &row;
    }
    return closest;
}

Ranking ranking_of(const Comparison& comparison) {
    Ranking result;
    for (const std::size_t index : comparison.pareto)
        if (index < comparison.rows.size()) result.front.push_back(&comparison.rows[index]);
    for (const Row* winner : result.front) {
        Ranking::Win win{winner, {}};
        for (const Row& row : comparison.rows)
            if (!on_front(comparison, row) && winner_over(result.front, row) == winner)
                win.losers.push_back(&row);
        if (!win.losers.empty()) result.wins.push_back(std::move(win));
    }
    for (const Row& row : comparison.rows) {
        if (!judged(&row))
            result.not_judged.push_back(&row);
        else if (row.mirrors_black)
            result.black.push_back(&row);
        else if (!on_front(comparison, row) && winner_over(result.front, row) == nullptr)
            result.beaten_by_beaten.push_back(&row);
    }
    return result;
}

TracingVerdict tracing_verdict(const Comparison& comparison) {
    TracingVerdict verdict;
    verdict.any_traced = std::ranges::any_of(comparison.rows, is_ray_traced);
    for (const Row& row : comparison.rows) {
        if (is_ray_traced(row) || !is_candidate(row)) continue;
        ++verdict.others;
        if (std::ranges::none_of(comparison.rows, [&](const Row& other) {
                return is_ray_traced(other) && beats(other, row);
            }))
            verdict.unbeaten.push_back(&row);
    }
    return verdict;
}

} // namespace catoptric::measure
