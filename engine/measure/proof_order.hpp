#pragma once

#include <cstddef>
#include <span>
#include <vector>

// Functions that decide which plans a choice proves, and in which order (docs/choose.md).
namespace catoptric::measure {

/// Returns the estimated probability, 0 to 1, that at most `max_failures` of `views` fresh views
/// exceed `limit`. `errors` are errors of a plan in other drawn views of the same scene. The
/// logarithms of errors are taken for normally distributed with unknown mean and deviation, so a
/// further logarithm follows Student's t distribution (Hahn, Factors for Calculating Two-Sided
/// Prediction Intervals, 1969). Errors below .03 of the limit count as .03. `added_deviation` is a
/// further standard deviation of logarithms, at least 0, because a few views seldom show the
/// largest errors of a scene. The estimate can order proofs, but proves nothing. Returns 0 with
/// fewer than two errors. With a limit of 0, returns 1 if all errors are 0, else 0.
double proof_probability(std::span<const double> errors, double limit, std::size_t views,
                         std::size_t max_failures, double added_deviation);

/// A plan that may be proved.
struct ProofCandidate {
    double ms = 0;          ///< time of a frame, above 0
    double probability = 0; ///< estimated probability that the proof succeeds, 0 to 1
};

/// Returns the indices of the plans to prove, from the slowest to the fastest, at most `max_count`
/// of them. Proofs end at the first that fails, and the last plan whose proof succeeded is chosen.
/// The order has the least expected logarithm of the chosen plan's time, if proofs succeed
/// independently. Having no plan counts as much as a plan that takes `no_plan_factor` times as long
/// as the slowest candidate. O(candidates^2 max_count).
std::vector<std::size_t> find_best_order(std::span<const ProofCandidate> candidates,
                                         std::size_t max_count, double no_plan_factor);

} // namespace catoptric::measure
