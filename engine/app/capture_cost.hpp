#pragma once

#include <cstdint>
#include <vector>

namespace catoptric::app {

/// How long it takes to draw a mirror's capture, by the last frames that drew some.
class CaptureCost {
public:
    /// A frame took so many milliseconds for the captures of so many mirrors; 0 mirrors say
    /// nothing.
    void add(double ms, std::uint32_t mirrors);
    /// As many mirrors as fit into the budget by the median of what was added last, at least 1 and
    /// at most `mirrors`; all where nothing was.
    std::uint32_t fitting(double budget_ms, std::uint32_t mirrors) const;

private:
    std::vector<double> each_ms_; ///< milliseconds a mirror, the newest last
};

} // namespace catoptric::app
