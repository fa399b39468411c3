#pragma once

#include "measure/comparison.hpp"

#include <cstddef>
#include <span>

namespace catoptric::measure {

/// Summary of the direction errors of a search.
struct LookupSummary {
    std::size_t pixels = 0;
    double mean_degrees = 0, p95_degrees = 0, p99_degrees = 0;
    double wrong_object = 0, unknown = 0, miss = 0; ///< shares of the pixels, 0..1
    double p95_residual = 0;                        ///< 95th percentile over hits
};

/// Direction error of one first-order mirror pixel: where it looked in the capture, compared with
/// where it should have looked.
struct LookupError {
    double angle_degrees = 0;  ///< angle between the two directions, 0..180
    bool wrong_object = false; ///< the capture shows another object in the looked-up direction
    int state = 0;             ///< state of the search: 0 hit, 1 unknown, 2 miss
    /// Relative difference between the distance that the search found and the captured one.
    double residual = 0;
};

/// All values are 0 for an empty list.
LookupSummary summarise_lookups(std::span<const LookupError> pixels);

/// Returns the angle between two directions in degrees. Small angles are exact too, because the
/// acos of a cosine near 1 is avoided.
double angle_between_degrees(const dvec3& a, const dvec3& b);

} // namespace catoptric::measure
