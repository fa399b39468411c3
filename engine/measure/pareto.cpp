#include "measure/pareto.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace catoptric::measure {

std::vector<std::size_t> pareto_front(std::span<const Candidate> candidates) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < candidates.size(); ++i)
        if (!std::isnan(candidates[i].cost) && !std::isnan(candidates[i].error)) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(candidates[a].cost, candidates[a].error, a) <
               std::tie(candidates[b].cost, candidates[b].error, b);
    });
    // Everything before a candidate costs less or as much: it must err less than all of them, or be
    // the same as the last one on the front.
    std::vector<std::size_t> front;
    for (const std::size_t i : order) {
        const Candidate& candidate = candidates[i];
        if (!front.empty()) {
            const Candidate& best = candidates[front.back()];
            const bool same = candidate.cost == best.cost && candidate.error == best.error;
            if (!same && candidate.error >= best.error) continue;
        }
        front.push_back(i);
    }
    return front;
}

} // namespace catoptric::measure
