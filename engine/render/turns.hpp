#pragma once

#include <cstdint>
#include <vector>

/// Whose captures a frame draws that may not draw all which are asked for.
namespace catoptric::render {

/// A mirror whose capture is to be drawn anew.
struct Asking {
    std::uint32_t mirror = 0;
    std::uint32_t waited = 0; ///< frames in which it was asked for and put off
};

/// Mirrors that are put off: all but the `most`, at least 1, that have waited longest, of equals
/// the first. Where put_off is asked frame after frame, of M that ask at once each is drawn in one
/// of the next ceil(M / most) frames, whoever asks later. O(n log n).
std::vector<std::uint32_t> put_off(std::vector<Asking> asking, std::uint32_t most);

} // namespace catoptric::render
