#pragma once

#include "../core/export.hpp"

#include <cstdint>
#include <string>

namespace catoptric::app {

/// What a frame did with captures of which it may not draw all (FrameSpec::most_captures,
/// FrameSpec::budget_ms).
struct CaptureBudget {
    std::uint32_t mirrors = 0; ///< that are captured
    std::uint32_t most = 0;    ///< of them are drawn again in a frame, 1 to `mirrors`
    std::uint32_t drawn = 0;   ///< in this frame, those among them that came into view
    std::uint32_t waiting = 0; ///< put off
    std::uint32_t longest = 0; ///< frames for which one has been put off by now

    /// Frames within which each that waits is drawn, for as long as `most` stays.
    std::uint32_t round() const { return most > 0 ? (mirrors + most - 1) / most : 1; }
};

/// "captures: at most 3 of 16 mirrors a frame; ...": how old what they show can be, a sentence.
CATOPTRIC_API std::string to_text(const CaptureBudget& slices);

} // namespace catoptric::app
