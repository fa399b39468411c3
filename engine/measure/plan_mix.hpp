#pragma once

#include <cstddef>
#include <vector>

// Functions that choose a technique for each mirror. The choice follows from the errors of
// techniques that drew all mirrors.
namespace catoptric::measure {

/// What one technique costs, and its error on each mirror in each view.
struct MixCandidate {
    double ms = 0; ///< time of a frame in which the technique draws all mirrors
    /// Sum over a mirror's pixels of the pixel's error, by view, then by mirror; 0 for a mirror
    /// that the view does not show.
    std::vector<std::vector<double>> error_sums;
};

/// Returns for each mirror the index of its technique in the list of candidates, found by greedy
/// exchange. The search begins with the cheapest candidate that keeps `limit` in every view. As
/// long as a mirror can get a cheaper candidate without breaking the limit in a view, the exchange
/// with the greatest saving per added error is made; the saving is the difference of times times
/// the mirror's share of the pixels. `pixels` has the number of pixels of each mirror, by view,
/// then by mirror. The error of a view is the sum over its mirrors divided by the number of their
/// pixels. Returns nothing if no candidate keeps the limit alone. Costs O(mirrors^2 candidates
/// views).
std::vector<std::size_t> find_fastest_mix(const std::vector<MixCandidate>& candidates,
                                          const std::vector<std::vector<double>>& pixels,
                                          double limit);

} // namespace catoptric::measure
