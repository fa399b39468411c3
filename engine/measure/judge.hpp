#pragma once

#include "measure/comparison.hpp"

#include <vector>

// Functions that rank rows: which row is faster, has less error, or is on the front. All code that
// writes, shows or chooses rows uses these rules.
namespace catoptric::measure {

/// Returns whether the row's picture has pixels that are NaN or infinite. Its metrics leave these
/// pixels out, so they are not judged.
bool has_nonfinite_pixels(const Row& row);
/// Returns whether the row's error over the mirrors is known and the row has not failed. Null gives
/// false.
bool has_known_error(const Row* row);
/// Returns whether the row takes part in fastest, closest and front. A candidate is judged and
/// draws something in its mirrors. A row with black mirrors only gives a lower bound for time.
bool is_row_eligible_for_ranking(const Row& row);
/// Returns whether the row's time is known. The time of a row whose picture is a file is NaN.
bool has_known_time(const Row& row);
/// Returns the interval of a's time divided by b's, round by round. The two times can be told apart
/// if the interval excludes 1. The interval is unknown if the rows have too few rounds in common.
Interval time_ratio_interval(const Row& a, const Row& b);
/// Returns whether a takes less time than b with 95 % confidence.
bool is_confidently_faster(const Row& a, const Row& b);
/// Returns whether neither row is faster than the other.
bool is_time_tie(const Row& a, const Row& b);
/// Returns whether a has less FLIP over the mirrors than b. If errors over drawn views are known,
/// the confidence interval of the difference decides. A difference below the noise of the reference
/// (find_flip_noise_floor) is a tie.
bool has_less_flip(const Row& a, const Row& b);
/// Returns whether row a is a better choice than row b: a is faster and has no larger error, or a
/// has less error and is not slower. A row without a time, or with black mirrors, neither beats a
/// row nor is beaten.
bool beats_row(const Row& a, const Row& b);

/// Returns the indices of the rows that no other row beats, in order of median time, then index.
/// This list is Comparison::pareto. Rows that tie may all be on the front. Costs O(n^2).
std::vector<std::size_t> find_pareto_front_of_rows(const std::vector<Row>& rows);

/// Places of a row in the order of time, from 1. `first` is one more than the number of rows that
/// are faster. `last` is the number of rows less those that this row is faster than. Rows that tie
/// share places. Both are 0 for a row without a known time, which takes no place from others.
struct TimeRankRange {
    std::size_t first = 1, last = 1;
};
TimeRankRange find_time_rank_range_of_row(const Comparison& comparison, const Row& row);

/// Returns the rows whose threads waited for processors that other programs used.
std::vector<const Row*> find_noisy_rows(const Comparison& comparison);

bool is_on_pareto_front(const Comparison& comparison, const Row& row);

/// Returns the candidates that no other candidate is faster than. Several are returned if their
/// times cannot be told apart.
std::vector<const Row*> find_fastest_rows(const Comparison& comparison);
/// Returns the candidate with the least FLIP over the mirrors, other than the reference itself.
/// Returns null if there is none.
const Row* find_closest_row(const Comparison& comparison);
/// Returns the other rows that find_closest_row could name as well, because their FLIP differs from
/// its FLIP by less than the noise of the reference. Empty for a reference without noise.
std::vector<const Row*> find_ties_with_closest_row(const Comparison& comparison);

/// Ranking of the rows: which row beats which.
struct RowRanking {
    struct RowWins {
        const Row* winner; ///< a row on the front
        std::vector<const Row*> losers;
    };
    std::vector<const Row*> front; ///< rows on the front, in order of time
    /// Pairs of rows in which the first row beats the second. Each beaten row is listed once, with
    /// the first row on the front that beats it.
    std::vector<RowWins> wins;
    std::vector<const Row*> beaten_by_beaten;
    std::vector<const Row*> not_judged;
    /// Judged rows that are no candidates because their mirrors are black.
    std::vector<const Row*> black;
    std::vector<const Row*> untimed; ///< judged rows without a known time
};
RowRanking rank_rows(const Comparison& comparison);

/// Answer to the question whether ray tracing beats all other rows.
struct RayTracingVerdict {
    bool any_traced = false;
    std::size_t others = 0;           ///< number of candidates that are not ray traced
    std::vector<const Row*> unbeaten; ///< the candidates that no ray-traced row beats
};
RayTracingVerdict find_ray_tracing_verdict(const Comparison& comparison);

} // namespace catoptric::measure
