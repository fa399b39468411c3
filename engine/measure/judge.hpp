#pragma once

#include "measure/comparison.hpp"

#include <vector>

// What rows are worth beside each other. Whoever writes, shows or chooses asks here.
namespace catoptric::measure {

/// It holds pixels that are no numbers: its figures leave them out and judge nothing.
bool failed(const Row& row);
/// Its error over the mirrors is known.
bool judged(const Row* row);
/// Returns whether the row takes part in fastest, closest and front: it is judged and draws
/// something in its mirrors. One with black mirrors is a floor for time.
bool is_candidate(const Row& row);
/// Of the ratio of two rows' times, round by round: the rows are apart in time where it excludes 1.
/// Unknown where they have too few rounds in common.
Interval time_ratio(const Row& a, const Row& b);
/// Whether a takes less time, and they are apart.
bool is_faster(const Row& a, const Row& b);
/// Neither is faster.
bool is_tie(const Row& a, const Row& b);
/// Whether a has less FLIP over the mirrors; where errors are known over views, whether the
/// interval of the difference says so.
bool is_closer(const Row& a, const Row& b);
/// Returns whether a is the better choice: faster and not farther off, or closer and not slower. A
/// row that is no candidate or took no time beats no row and is beaten by none.
bool beats(const Row& a, const Row& b);

/// Indices of the rows that no other row beats, in order of time, then index: Comparison::pareto.
/// Rows that tie stay on it together. Costs O(n^2).
std::vector<std::size_t> front_of(const std::vector<Row>& rows);

/// Places in the order of time, from 1: one more than the rows that are faster, to the rows that
/// it is not faster than. Rows that tie share a place.
struct Places {
    std::size_t first = 1, last = 1;
};
Places places_in_time(const Comparison& comparison, const Row& row);

/// The rows whose threads waited for a processor: others were at work beside.
std::vector<const Row*> noisy_rows(const Comparison& comparison);

bool on_front(const Comparison& comparison, const Row& row);

/// Candidates that no other candidate is faster than: one, or several that are not told apart.
std::vector<const Row*> fastest_rows(const Comparison& comparison);
/// The candidate of least FLIP over the mirrors but for the reference itself; null where there is
/// none.
const Row* closest_row(const Comparison& comparison);

/// Who beats whom.
struct Ranking {
    struct Win {
        const Row* winner; ///< on the front
        std::vector<const Row*> losers;
    };
    std::vector<const Row*> front; ///< in order of time
    std::vector<Win> wins;         ///< each loser under the first on the front that beats it
    std::vector<const Row*> beaten_by_beaten;
    std::vector<const Row*> not_judged;
    std::vector<const Row*> black; ///< judged, but no candidates: their mirrors are black
};
Ranking ranking_of(const Comparison& comparison);

/// Whether tracing rays beats everything else.
struct TracingVerdict {
    bool any_traced = false;
    std::size_t others = 0;           ///< judged rows that trace none and draw their mirrors
    std::vector<const Row*> unbeaten; ///< of these, by any ray-traced row
};
TracingVerdict tracing_verdict(const Comparison& comparison);

} // namespace catoptric::measure
