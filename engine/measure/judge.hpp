#pragma once

#include "measure/comparison.hpp"
#include "measure/interval.hpp"

#include <string_view>
#include <vector>

// Functions that judge rows: which row is faster, has less error, or is on the front. All code that
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
bool is_rankable(const Row& row);
/// The time of a row whose picture is a file is NaN.
bool has_known_time(const Row& row);
/// Returns whether the row is a candidate with a known time above 0 and a known FLIP. Only such
/// rows beat others or are beaten.
bool is_judged(const Row& row);
/// Returns the name of the metric by which the rows are judged: "cpu_ms" on a processor, unless all
/// rows share their frames, "frame_ms" for a moving scene, and otherwise "gpu_ms".
std::string_view judged_time(const Comparison& comparison);
/// Returns the interval of a's time divided by b's, round by round. The interval is unknown if the
/// rows have too few rounds in common.
Interval time_ratio_interval(const Row& a, const Row& b);

/// Two times are equal if the 95 % interval of their ratio, round by round, lies within this ratio
/// to both sides.
inline constexpr double kEqualTimeRatio = 1.05;
/// Two FLIP are equal if they differ by at most this, or by at most the noise of the reference
/// (flip_noise_floor).
inline constexpr double kEqualFlip = .002;

/// Returns the order of two times: `equal` within kEqualTimeRatio, `less` or `more` if the interval
/// of the ratio excludes 1, and otherwise `unknown`. Of 100 pairs of rows that take the same time,
/// at most 5 get another order than `equal` or `unknown`.
Order compare_times(const Row& a, const Row& b);
/// Returns the order of two FLIP over the mirrors. Over drawn views, the 95 % interval of the
/// difference, view by view, decides, and differences below the noise of the reference count as 0.
Order compare_flip(const Row& a, const Row& b);

/// Judges pairs of rows of one comparison. If the rounds do not show that any two of its rows
/// differ in time, no row counts as faster than another: among many rows that take the same time,
/// chance alone makes some pairs differ. Friedman's test decides, with 5 % of errors (Friedman, The
/// use of ranks to avoid the assumption of normality, 1937).
class RowJudge {
public:
    /// Judges the rows of a comparison. Costs O(rows log rows) for each round.
    explicit RowJudge(const std::vector<Row>& rows);
    Order times(const Row& a, const Row& b) const;
    Order flip(const Row& a, const Row& b) const { return compare_flip(a, b); }
    /// Returns whether row a is a better choice than row b. It has less time or less FLIP, and the
    /// other of the two is less as well or equal. No two rows beat each other.
    bool beats(const Row& a, const Row& b) const;
    /// Returns whether it cannot be told if a beats b, because the order of a time or a FLIP is
    /// unknown.
    bool is_open(const Row& a, const Row& b) const;

private:
    bool times_differ_;
};

/// Returns the indices of the rows that no other row beats, in order of median time, then index.
/// This list is Comparison::pareto. Costs O(n^2).
std::vector<std::size_t> find_pareto_front(const std::vector<Row>& rows);

/// Places of a row in the order of time, from 1. `first` is one more than the number of rows that
/// are faster. `last` is the number of rows less those that this row is faster than. Rows whose
/// times are equal, or cannot be told apart, share places. Both are 0 for a row without a known
/// time, which takes no place from others.
struct RankRange {
    std::size_t first = 1, last = 1;
};
RankRange find_rank_range(const Comparison& comparison, const Row& row);

/// Returns the rows whose threads waited for processors that other programs used.
std::vector<const Row*> find_noisy_rows(const Comparison& comparison);

bool is_on_front(const Comparison& comparison, const Row& row);

/// The candidates that no other candidate is faster than.
struct FastestRows {
    std::vector<const Row*> rows;
    /// Whether the times of all these rows are equal. Otherwise one of them is the fastest, and the
    /// measurement cannot tell which.
    bool are_equal = true;
    std::size_t candidates = 0; ///< number of candidates with a known time
};
FastestRows find_fastest_rows(const Comparison& comparison);
/// Returns the candidate with the least FLIP over the mirrors, other than the reference itself.
/// Returns null if there is none.
const Row* find_closest_row(const Comparison& comparison);
/// Returns the other rows that find_closest_row could name as well, because its FLIP is not less
/// than theirs (compare_flip).
std::vector<const Row*> find_closest_ties(const Comparison& comparison);

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
    /// Rows on the front of which it cannot be told whether another row beats them.
    std::vector<const Row*> open;
    std::vector<const Row*> not_judged;
    /// Judged rows that are no candidates because their mirrors are black.
    std::vector<const Row*> black;
    std::vector<const Row*> untimed; ///< judged rows without a known time
};
RowRanking rank_rows(const Comparison& comparison);

/// Answer to the question whether ray tracing beats all other rows.
struct RayTracingVerdict {
    bool any_traced = false; ///< whether there is a ray-traced row, judged or not
    /// The judged rows that are not ray traced: those that a ray-traced row beats, those that none
    /// beats, and those of which this cannot be told.
    std::vector<const Row*> beaten, unbeaten, open;

    std::size_t others() const { return beaten.size() + unbeaten.size() + open.size(); }
};
RayTracingVerdict find_ray_tracing_verdict(const Comparison& comparison);

} // namespace catoptric::measure
