#pragma once

#include <cstdint>
#include <vector>

namespace catoptric::session {

/// Estimate of the time that a mirror's capture takes to draw, from the last frames that drew
/// captures.
class CaptureCost {
public:
    /// Adds a frame that took `ms` milliseconds to draw the captures of `mirrors` mirrors. A frame
    /// with 0 mirrors is ignored.
    void add(double ms, std::uint32_t mirrors);
    /// Returns how many of `mirrors` captures fit into the budget, by the median of the frames
    /// added last. Returns at least 1, and `mirrors` if no frame was added.
    std::uint32_t count_affordable(double budget_ms, std::uint32_t mirrors) const;

private:
    std::vector<double> each_ms_; ///< milliseconds per mirror, the newest last
};

} // namespace catoptric::session
