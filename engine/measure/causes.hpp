#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// A row's error by cause: what goes when one thing after another is replaced by the reference's
/// own.
namespace catoptric::measure {

/// Squared errors are means over mirror pixels and channels, linear, both pictures clamped to
/// [0,1]; entry n-1 of a vector is mirror n. A part is negative where mending this uncovers
/// another's error.
struct Cause {
    std::string name;
    double squared_error = 0; ///< its part of the row's; all parts add up to it
    /// The same in parts of the row's, 1 in sum; NaN where that is 0.
    double share = NAN;
    /// What of `share` lies in pixels whose reflected ray meets no second mirror, and in the
    /// others.
    double share_first_order = NAN, share_mirror_in_mirror = NAN;
    std::vector<double> share_per_mirror; ///< ... and in each mirror's
    /// Squared error that goes when this is mended alone, before all others; NaN: it cannot be.
    double alone = NAN;
    std::vector<double> alone_per_mirror; ///< the same of each mirror, mean over its own pixels
};

struct Causes {
    double squared_error = 0;                     ///< of the row itself
    std::vector<double> squared_error_per_mirror; ///< mean over each mirror's own pixels
    std::vector<Cause> list;
    double rest_rmse = 0; ///< when all is mended: near 0 where no cause is missing
    /// Row-major: 1 + index in `list` of the cause with the largest part of the pixel's squared
    /// error; 0: no mirror, or the pixel is not off (kOff).
    std::vector<std::uint8_t> largest;
};

/// Parts of every mirror pixel's squared error that one cause has.
struct PixelCause {
    std::string name;
    std::vector<double> part;
    std::vector<double> alone; ///< empty: it cannot be mended alone
};

/// Places of the mirrors' pixels in the picture, ascending.
CATOPTRIC_API std::vector<std::size_t> mirror_pixels(std::span<const std::uint32_t> hits);

/// Sums what is known of each of `mirror_pixels(hits)`: the row's squared error `whole`, which the
/// parts of `causes` add up to, the last of them being what nothing explains. Pixels that are not
/// finite in one of them are left out, as in `difference`. `off`, of the whole picture, says which
/// to name in `largest`.
CATOPTRIC_API Causes sum_up(std::span<const std::uint32_t> hits, const Mask& off,
                            std::span<const double> whole, const std::vector<PixelCause>& causes);

} // namespace catoptric::measure
