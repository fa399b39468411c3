#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric::measure {

/// A choice to be judged: less is better in both.
struct Candidate {
    double cost = 0;
    double cost_low = 0, cost_high = 0; ///< costs within this band are not told apart from it
    double error = 0;
};

/// Whether one is the better choice: cheaper, their bands apart, with no more error; or with less
/// error and not dearer with their bands apart. A NaN beats nobody and is beaten by nobody.
bool beats(const Candidate& a, const Candidate& b);

/// Indices of the candidates that no other one beats, equal and tied ones together, in order of
/// cost, then index. A NaN is never on it. Costs O(n^2).
std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates);

} // namespace catoptric::measure
