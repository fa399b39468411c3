#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric::measure {

/// A choice to be judged: less is better in both.
struct Candidate {
    double cost = 0;
    double error = 0;
};

/// Indices of the candidates that no other one beats: none has both less or equal cost and less or
/// equal error, one of them less. Equal candidates are on the front together. A NaN is never on it
/// and beats nobody. In order of cost, then index. Costs O(n log n).
std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates);

} // namespace catoptric::measure
