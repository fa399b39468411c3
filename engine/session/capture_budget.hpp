#pragma once

#include "../core/export.hpp"

#include <cstdint>
#include <string>

namespace catoptric::app {

/// Outcome of a frame that may not draw all captures again (FrameSpec::most_captures,
/// FrameSpec::budget_ms).
struct CaptureBudget {
    std::uint32_t mirrors = 0; ///< number of captured mirrors
    std::uint32_t most = 0;    ///< mirrors that a frame draws again at most, 1 to `mirrors`
    /// Mirrors drawn in this frame, including those that came into view.
    std::uint32_t drawn = 0;
    std::uint32_t waiting = 0; ///< mirrors whose captures had to wait for a later frame
    std::uint32_t longest = 0; ///< number of frames for which the oldest capture has waited

    /// Returns the number of frames within which each waiting capture is drawn, as long as `most`
    /// does not change.
    std::uint32_t round() const { return most > 0 ? (mirrors + most - 1) / most : 1; }
};

/// Returns a sentence that says how old captured content can be: "captures: at most 3 of 16 mirrors
/// a frame; ...".
CATOPTRIC_API std::string to_text(const CaptureBudget& slices);

} // namespace catoptric::app
