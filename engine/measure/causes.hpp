#pragma once

#include "measure/comparison.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Data of a row's error, split by cause, and functions that sum it.
namespace catoptric::measure {

/// Part of a row's error that one cause contributes. Squared errors are means over mirror pixels
/// and channels, in linear RGB, with both pictures clamped to [0,1]. Entry n-1 of a vector belongs
/// to mirror n. A part is negative if removing this cause uncovers the error of another.
struct CauseShare {
    std::string name;
    /// Part of the row's squared error; all parts add up to the whole.
    double squared_error = 0;
    /// The part divided by the row's squared error, so that all shares add up to 1. NaN if the
    /// row's error is 0.
    double share = NAN;
    /// Parts of `share`: in pixels whose reflected ray meets no second mirror, and in the other
    /// mirror pixels.
    double share_first_order = NAN, share_mirror_in_mirror = NAN;
    std::vector<double> share_per_mirror; ///< parts of `share` in the pixels of each mirror
    /// Squared error that goes away if only this cause is removed. NaN if the cause cannot be
    /// removed alone.
    double alone = NAN;
    /// `alone` of each mirror, as a mean over its own pixels.
    std::vector<double> alone_per_mirror;
};

struct Causes {
    double squared_error = 0;                     ///< squared error of the row
    std::vector<double> squared_error_per_mirror; ///< mean over each mirror's own pixels
    std::vector<CauseShare> list;
    double rest_rmse = 0; ///< rmse with all causes removed; near 0 if no cause is missing
    /// Cause with the largest part of each pixel's squared error, row-major, as 1 + its index in
    /// `list`. 0 means that the pixel shows no mirror or is not off
    /// (kMaxInvisibleDifference).
    std::vector<std::uint8_t> largest;
};

/// Part of the squared error of each mirror pixel that one cause contributes.
struct PixelCause {
    std::string name;
    std::vector<double> part;
    std::vector<double> alone; ///< empty if the cause cannot be removed alone
};

/// Returns the row-major indices of the pixels whose first hit is a mirror, in ascending order.
std::vector<std::size_t> mirror_pixels(std::span<const std::uint32_t> hits);

/// Sums the squared errors of `mirror_pixels(hits)` to means and shares. `whole` is the row's
/// squared error of each of these pixels. The parts of `causes` add up to it, and the last cause is
/// the unexplained rest. Pixels with a value that is not finite are left out, as in `difference`.
/// `off` is a mask of the whole picture and says which pixels get a cause in `largest`. Throws
/// `internal` if a list has another length than the number of mirror pixels.
Causes summarise_causes(std::span<const std::uint32_t> hits, const Mask& off,
                        std::span<const double> whole, const std::vector<PixelCause>& causes);

} // namespace catoptric::measure
