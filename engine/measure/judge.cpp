#include "measure/judge.hpp"

#include "measure/halves.hpp"
#include "measure/metric.hpp"
#include "measure/rows.hpp"
#include "measure/views.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace catoptric::measure {

namespace {

/// Returns the first row on the front that beats this row, or null if none does.
const Row* find_dominating(const RowJudge& judge, const std::vector<const Row*>& front,
                           const Row& loser) {
    const auto found = std::ranges::find_if(
        front, [&](const Row* row) { return judge.beats(*row, loser); });
    return found == front.end() ? nullptr : *found;
}

/// Returns the ranks of values, from 1. Equal values share the mean of their ranks.
std::vector<double> rank_values(std::span<const double> values) {
    std::vector<double> ranks;
    for (const double value : values) {
        const auto less = std::ranges::count_if(values,
                                                [&](double other) { return other < value; }),
                   equal = std::ranges::count(values, value);
        ranks.push_back(static_cast<double>(less) + (static_cast<double>(equal) + 1) / 2);
    }
    return ranks;
}

/// Returns the value that a chi-square variable exceeds with a probability of 2.5 %, by the formula
/// of Wilson and Hilferty (1931).
double chi_square_limit(double degrees) {
    constexpr double kNormalQuantile = 1.959964; // of 97.5 %
    const double variance = 2 / (9 * degrees);
    return degrees * std::pow(1 - variance + kNormalQuantile * std::sqrt(variance), 3);
}

/// Returns whether Friedman's test shows that some of the rows differ in time. False for fewer than
/// kMinIntervalSamples common rounds. With few rounds its statistic is only about that of
/// chi-square: a limit of 5 % gave 6 % of errors in drawn tables, so the limit is 2.5 %.
bool times_differ(const std::vector<Row>& rows) {
    std::vector<const std::vector<double>*> times;
    for (const Row& row : rows)
        if (has_known_time(row) && row.time_ms().rounds.size() >= kMinIntervalSamples)
            times.push_back(&row.time_ms().rounds);
    if (times.size() < 2) return false;
    std::size_t rounds = times.front()->size();
    for (const auto* row : times) rounds = std::min(rounds, row->size());
    const auto count = static_cast<double>(times.size()), round_count = static_cast<double>(rounds);
    // Variances of the ranks: of their sums over rounds, and within rounds. Shared ranks lower
    // both.
    std::vector<double> sums(times.size()), in_round(times.size());
    double within = 0;
    for (std::size_t round = 0; round < rounds; ++round) {
        for (std::size_t i = 0; i < times.size(); ++i) in_round[i] = (*times[i])[round];
        const std::vector<double> ranks = rank_values(in_round);
        for (std::size_t i = 0; i < times.size(); ++i) {
            sums[i] += ranks[i];
            within += std::pow(ranks[i] - (count + 1) / 2, 2);
        }
    }
    if (!(within > 0)) return false;
    double between = 0;
    for (const double sum : sums) between += std::pow(sum - round_count * (count + 1) / 2, 2);
    return (count - 1) * between / within > chi_square_limit(count - 1);
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

bool is_rankable(const Row& row) { return has_known_error(&row) && !row.mirrors_black; }

bool has_known_time(const Row& row) { return !std::isnan(row.time_ms().median); }

bool is_judged(const Row& row) {
    return is_rankable(row) && !std::isnan(row.error.flip) && row.time_ms().median > 0;
}

std::string_view judged_time(const Comparison& comparison) {
    const auto timed = std::ranges::find_if(comparison.rows, has_known_time);
    return timed == comparison.rows.end() ? Row().time_metric() : timed->time_metric();
}

Interval time_ratio_interval(const Row& a, const Row& b) {
    return median_ratio_interval(a.time_ms().rounds, b.time_ms().rounds);
}

Order compare_times(const Row& a, const Row& b) {
    const Interval ratio = time_ratio_interval(a, b);
    if (ratio.low >= 1 / kEqualTimeRatio && ratio.high <= kEqualTimeRatio) return Order::equal;
    return compare_to_limit(ratio, 1);
}

Order compare_flip(const Row& a, const Row& b) {
    if (!a.views.empty() || !b.views.empty()) {
        const Interval difference = metric_difference_interval(a, b, "flip");
        if (difference.low >= -kEqualFlip && difference.high <= kEqualFlip) return Order::equal;
        return compare_to_limit(difference, 0);
    }
    const double difference = a.error.flip - b.error.flip;
    if (std::isnan(difference)) return Order::unknown;
    if (std::abs(difference) <= std::max(kEqualFlip, flip_noise_floor(a.error, b.error)))
        return Order::equal;
    return difference < 0 ? Order::less : Order::more;
}

RowJudge::RowJudge(const std::vector<Row>& rows) : times_differ_(times_differ(rows)) {}

Order RowJudge::times(const Row& a, const Row& b) const {
    const Order order = compare_times(a, b);
    return times_differ_ || order == Order::equal ? order : Order::unknown;
}

bool RowJudge::beats(const Row& a, const Row& b) const {
    if (!is_judged(a) || !is_judged(b)) return false;
    const Order time = times(a, b), error = flip(a, b);
    return (time == Order::less && (error == Order::less || error == Order::equal)) ||
           (time == Order::equal && error == Order::less);
}

bool RowJudge::is_open(const Row& a, const Row& b) const {
    if (&a == &b || !is_judged(a) || !is_judged(b)) return false;
    const Order time = times(a, b), error = flip(a, b);
    return (time == Order::unknown && error != Order::more) ||
           (error == Order::unknown && time != Order::more);
}

std::vector<std::size_t> find_pareto_front(const std::vector<Row>& rows) {
    const RowJudge judge(rows);
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (is_judged(rows[i]) && std::ranges::none_of(rows, [&](const Row& other) {
                return judge.beats(other, rows[i]);
            }))
            front.push_back(i);
    std::ranges::stable_sort(front, {}, [&](std::size_t i) { return rows[i].time_ms().median; });
    return front;
}

RankRange find_rank_range(const Comparison& comparison, const Row& row) {
    if (!has_known_time(row)) return {0, 0};
    const RowJudge judge(comparison.rows);
    RankRange places{1, 0};
    for (const Row& other : comparison.rows) {
        if (!has_known_time(other)) continue;
        ++places.last;
        const Order order = judge.times(other, row);
        places.first += order == Order::less;
        places.last -= order == Order::more;
    }
    return places;
}

std::vector<const Row*> find_noisy_rows(const Comparison& comparison) {
    std::vector<const Row*> noisy;
    for (const Row& row : comparison.rows)
        if (row.noisy) noisy.push_back(&row);
    return noisy;
}

bool is_on_front(const Comparison& comparison, const Row& row) {
    return std::ranges::any_of(comparison.pareto, [&](std::size_t index) {
        return index < comparison.rows.size() && &comparison.rows[index] == &row;
    });
}

FastestRows find_fastest_rows(const Comparison& comparison) {
    const RowJudge judge(comparison.rows);
    std::vector<const Row*> timed;
    for (const Row& row : comparison.rows)
        if (is_rankable(row) && has_known_time(row)) timed.push_back(&row);
    FastestRows fastest;
    fastest.candidates = timed.size();
    for (const Row* row : timed)
        if (std::ranges::none_of(
                timed, [&](const Row* other) { return judge.times(*other, *row) == Order::less; }))
            fastest.rows.push_back(row);
    for (const Row* a : fastest.rows)
        for (const Row* b : fastest.rows)
            fastest.are_equal = fastest.are_equal &&
                                (a == b || judge.times(*a, *b) == Order::equal);
    return fastest;
}

const Row* find_closest_row(const Comparison& comparison) {
    const Row* closest = nullptr;
    for (const Row& row : comparison.rows) {
        if (row.is_reference || !is_rankable(row)) continue;
        if (closest == nullptr || row.error.flip < closest->error.flip) closest = &row;
    }
    return closest;
}

std::vector<const Row*> find_closest_ties(const Comparison& comparison) {
    std::vector<const Row*> ties;
    const Row* closest = find_closest_row(comparison);
    for (const Row& row : comparison.rows) {
        if (closest == nullptr || &row == closest || row.is_reference || !is_rankable(row))
            continue;
        if (compare_flip(*closest, row) != Order::less) ties.push_back(&row);
    }
    return ties;
}

RowRanking rank_rows(const Comparison& comparison) {
    const RowJudge judge(comparison.rows);
    RowRanking result;
    for (const std::size_t index : comparison.pareto)
        if (index < comparison.rows.size()) result.front.push_back(&comparison.rows[index]);
    for (const Row* winner : result.front) {
        if (std::ranges::any_of(comparison.rows,
                                [&](const Row& row) { return judge.is_open(row, *winner); }))
            result.open.push_back(winner);
        RowRanking::RowWins win{winner, {}};
        for (const Row& row : comparison.rows)
            if (!is_on_front(comparison, row) &&
                find_dominating(judge, result.front, row) == winner)
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
        else if (!is_on_front(comparison, row) &&
                 find_dominating(judge, result.front, row) == nullptr)
            result.beaten_by_beaten.push_back(&row);
    }
    return result;
}

RayTracingVerdict find_ray_tracing_verdict(const Comparison& comparison) {
    const RowJudge judge(comparison.rows);
    std::vector<const Row*> traced, others;
    for (const Row& row : comparison.rows)
        if (is_judged(row)) (is_ray_traced(row) ? traced : others).push_back(&row);
    RayTracingVerdict verdict;
    verdict.any_traced = std::ranges::any_of(comparison.rows, is_ray_traced);
    for (const Row* row : others) {
        const bool is_beaten = std::ranges::any_of(
                       traced, [&](const Row*other) { return judge.beats(*other, *row); }),
                   is_open = std::ranges::any_of(
                       traced, [&](const Row*other) { return judge.is_open(*other, *row); });
        (is_beaten ? verdict.beaten : is_open ? verdict.open : verdict.unbeaten).push_back(row);
    }
    return verdict;
}

} // namespace catoptric::measure
