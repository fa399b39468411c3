#pragma once

#include "measure/comparison.hpp"
#include "measure/pareto.hpp"

#include <vector>

// What rows are worth beside each other. Whoever writes, shows or chooses asks here.
namespace catoptric::measure {

/// It holds pixels that are no numbers: its figures leave them out and judge nothing.
bool failed(const Row& row);
/// Its error over the mirrors is known.
bool judged(const Row* row);
/// What the row is judged by: its median time with the band from the 5th to the 95th percentile,
/// and its FLIP over the mirrors. All NaN where it failed.
Candidate candidate_of(const Row& row);
/// See beats of two candidates: no row beats another where their bands of time overlap and it is
/// not closer.
bool beats(const Row& a, const Row& b);
/// Whether the bands of two rows' times do not overlap.
bool is_faster(const Row& a, const Row& b);
/// Neither is faster.
bool is_tie(const Row& a, const Row& b);

/// Indices of the rows that no other row beats, in order of time: Comparison::pareto.
std::vector<std::size_t> front_of(const std::vector<Row>& rows);
bool on_front(const Comparison& comparison, const Row& row);

/// Rows that no other is faster than, mirrors drawn: one, or several that are not told apart.
std::vector<const Row*> fastest_rows(const Comparison& comparison);
/// The least FLIP over the mirrors but for the reference itself; null where none is judged.
const Row* closest_row(const Comparison& comparison);

/// Who beats whom.
struct Standing {
    struct Win {
        const Row* winner; ///< on the front
        std::vector<const Row*> losers;
    };
    std::vector<const Row*> front; ///< in order of time
    std::vector<Win> wins;         ///< each loser under the first on the front that beats it
    std::vector<const Row*> beaten_by_beaten;
    std::vector<const Row*> not_judged;
};
Standing standing(const Comparison& comparison);

/// Whether tracing rays beats everything else.
struct TracingVerdict {
    bool any_traced = false;
    std::size_t others = 0;           ///< judged rows that trace none and draw their mirrors
    std::vector<const Row*> unbeaten; ///< of these, by any ray-traced row
};
TracingVerdict tracing_verdict(const Comparison& comparison);

} // namespace catoptric::measure
