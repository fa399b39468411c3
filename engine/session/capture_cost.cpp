#include "session/capture_cost.hpp"

#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::session {

namespace {

constexpr std::size_t kCaptureCostFrames =
    9; // odd, for the median; few, because motion changes the cost

} // namespace

void CaptureCost::add(double ms, std::uint32_t mirrors) {
    if (mirrors == 0) return;
    if (each_ms_.size() == kCaptureCostFrames) each_ms_.erase(each_ms_.begin());
    each_ms_.push_back(ms / mirrors);
}

std::uint32_t CaptureCost::count_affordable(double budget_ms, std::uint32_t mirrors) const {
    if (each_ms_.empty()) return mirrors;
    const double fit = std::floor(budget_ms / measure::percentile(each_ms_, .5));
    // If the time of a capture is too short to be measured, all captures fit into the budget.
    if (!(fit < mirrors)) return mirrors;
    return std::max(1u, static_cast<std::uint32_t>(fit));
}

} // namespace catoptric::session
