#pragma once

#include "measure/comparison.hpp"

#include <string>

namespace catoptric::measure {

/// How far the reference of a comparison is from a path-traced picture of the same view: FLIP of a
/// small picture of the reference and of the mean of all paths.
struct PathDistance {
    double flip = Difference::kNone;  ///< over the mirrors; NaN: not known, or no mirror is seen
    double noise = Difference::kNone; ///< FLIP between two halves of the paths, over the mirrors
    double flip_all = Difference::kNone, noise_all = Difference::kNone; ///< over the whole picture
    int width = 0, height = 0;
    int paths = 0;           ///< paths of each pixel, in both halves together
    double seconds = 0;      ///< processor time that the paths took
    double most_seconds = 0; ///< limit of this time
    bool is_kept = false;    ///< read from the cache, so that no path was traced
    std::string unknown;     ///< why the distance is not known; empty: it is known
    std::string command;     ///< finds out, in a larger picture and with more time

    bool is_known() const { return unknown.empty(); }
};

/// Returns the FLIP over the mirrors, or over the whole picture if it shows no mirror, with the
/// noise taken off and added. By the triangle inequality, the FLIP to a picture without noise lies
/// between: the mean of both halves is nearer to that picture than the halves are to each other.
Interval distance_interval(const PathDistance& distance);

/// Returns whether more paths would say little: the noise is at most a quarter of the distance, or
/// at most .01.
bool is_precise(const PathDistance& distance);

} // namespace catoptric::measure
