#include "measure/pareto.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

bool is_judged(const Candidate& candidate) {
    return !std::isnan(candidate.cost) && !std::isnan(candidate.cost_low) &&
           !std::isnan(candidate.cost_high) && !std::isnan(candidate.error);
}

bool is_cheaper(const Candidate& a, const Candidate& b) { return a.cost_high < b.cost_low; }

} // namespace

bool beats(const Candidate& a, const Candidate& b) {
    if (!is_judged(a) || !is_judged(b)) return false;
    return (is_cheaper(a, b) && a.error <= b.error) || (a.error < b.error && !is_cheaper(b, a));
}

std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates) {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Candidate& candidate = candidates[i];
        const bool beaten = std::ranges::any_of(
            candidates, [&](const Candidate& other) { return beats(other, candidate); });
        if (is_judged(candidate) && !beaten) front.push_back(i);
    }
    std::ranges::stable_sort(front, {}, [&](std::size_t i) { return candidates[i].cost; });
    return front;
}

} // namespace catoptric::measure
