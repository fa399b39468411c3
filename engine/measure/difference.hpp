#pragma once

#include "../core/export.hpp"
#include "picture.hpp"

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace catoptric::measure {

/// Difference of two pictures over the pixels of a mask. All values but `flip` are computed on
/// linear RGB after exposure (`exposed` of measure/picture.hpp), with both pictures clamped to
/// [0,1]. If no pixel of the mask is finite, each metric is NaN (null in JSON) and the place of the
/// maximum is (-1, -1). The metrics are not 0 then, because 0 would mean "no error".
struct Difference {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    std::size_t pixels = 0; ///< pixels of the mask, including those that are not finite
    /// Pixels with a NaN or infinity in either picture. The metrics leave these pixels out. If
    /// there are any, the row has failed, whatever its metrics are.
    std::size_t nonfinite = 0;
    double rmse = kNone;        ///< root of the mean square over pixels and channels, 0..1
    double mae = kNone;         ///< mean absolute difference over pixels and channels, 0..1
    double flip = kNone;        ///< mean of the FLIP map, 0..1
    std::optional<double> psnr; ///< -20 log10 rmse in dB; empty if rmse is 0 or NaN
    double p99 = kNone;         ///< 99th percentile of the pixels' largest channel difference, 0..1
    double max = kNone;         ///< the largest channel difference of all, 0..1
    /// Pixel with the largest difference; the first in reading order if there are several.
    int max_x = -1;
    int max_y = -1;
    double off = kNone; ///< share of the finite pixels of the mask that are off (kOff), 0..1
    /// Longest line of pixels that are off, in pixels: `longest_line` of measure/lines.hpp.
    double longest_line = kNone;
    /// Values of the metrics that are computed from pictures (Metric::PictureFunction).
    std::vector<double> others;
};

/// Returns the difference of two pictures over the pixels of `mask`. An empty mask means all
/// pixels. `flip_map` is `flip` of the two whole pictures as displayed. The caller computes the map
/// once, and each mask takes its mean. The result is symmetric in `a` and `b`. Throws `bad_data` if
/// pictures, mask or map differ in size.
CATOPTRIC_API Difference difference(const Picture& a, const Picture& b, const Mask& mask,
                                    std::span<const float> flip_map);

/// Whether values are averaged as they are or clamped to [0,1] first.
enum class Range { unclamped, clamped };

/// Mean of a picture in linear RGB, by channel and over all three.
struct Mean {
    dvec3 rgb{Difference::kNone};
    double all = Difference::kNone;
};

/// Returns the mean over the pixels of the mask, or NaN if the mask has none. The mean is not
/// finite if a pixel is NaN or, unclamped, infinite.
CATOPTRIC_API Mean mean_of(const Picture& picture, Range range, const Mask& mask = {});

} // namespace catoptric::measure
