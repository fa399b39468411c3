#pragma once

#include <cstdint>
#include <vector>

/// The capture budget: which captures a frame draws if it may not draw all of those requested.
namespace catoptric::render {

/// A mirror whose capture has to be drawn again.
struct RedrawRequest {
    std::uint32_t mirror = 0;
    std::uint32_t waited = 0; ///< number of frames for which the redraw has waited
};

/// Returns the mirrors whose captures must wait for a later frame: all except the `most` (at least
/// 1) that have waited longest. Between equals, the lower mirror number goes first. If M mirrors
/// ask at once and choose_postponed runs in every frame, each is drawn within the
/// next ceil(M / most) frames. Later requests do not delay them. Costs O(n log n).
std::vector<std::uint32_t> choose_postponed(std::vector<RedrawRequest> asking, std::uint32_t most);

} // namespace catoptric::render
