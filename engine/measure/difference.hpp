#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace catoptric::measure {

/// How far two pictures are apart where a mask says. All but `flip` are on linear RGB as exposed
/// (`exposed` of measure/picture.hpp), both clamped to [0,1]. Where there is no finite pixel to
/// judge, every figure is NaN (null in JSON) and the place is (-1, -1): no answer is not "no
/// error".
struct Difference {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::size_t pixels = 0; ///< in the mask, the non-finite ones included
    /// Pixels with a NaN or infinity in either picture. More than 0 means failed, whatever the
    /// figures, which leave these pixels out.
    std::size_t nonfinite = 0;
    double rmse = kNone;        ///< root of the mean square over pixels and channels, 0..1
    double mae = kNone;         ///< mean absolute difference over pixels and channels, 0..1
    double flip = kNone;        ///< mean of the FLIP map, 0..1
    std::optional<double> psnr; ///< -20 log10 rmse in dB; none when rmse is 0 or NaN
    double p99 = kNone;         ///< 99th percentile of the pixels' largest channel difference, 0..1
    double max = kNone;         ///< the largest channel difference of all, 0..1
    int max_x = -1;             ///< where; the first in reading order of several
    int max_y = -1;
    double off = kNone; ///< share of the judged pixels that are off (kOff), 0..1
    double longest_line =
        kNone;                  ///< of these pixels, in pixels: `longest_line` of measure/lines.hpp
    std::vector<double> others; ///< figures that others compute (Metric::OfPictures)
};

/// `flip_map` is `flip` of the two whole pictures as displayed: computed once, averaged over each
/// mask. Symmetric in a and b. Pictures, mask or map of different sizes: `Failure::bad_data`.
CATOPTRIC_API Difference difference(const Picture& a, const Picture& b, const Mask& mask,
                                    std::span<const float> flip_map);

/// Whether values are averaged as they are or clamped to [0,1] first.
enum class Range { unclamped, clamped };

/// Mean of a picture, linear, by channel and over all three.
struct Mean {
    dvec3 rgb{Difference::kNone};
    double all = Difference::kNone;
};

/// Over the pixels that count; NaN when none does. A NaN or (unclamped) infinite pixel makes the
/// mean so, too.
CATOPTRIC_API Mean mean_of(const Picture& picture, Range range, const Mask& mask = {});

} // namespace catoptric::measure
