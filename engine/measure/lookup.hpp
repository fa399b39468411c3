#pragma once

#include "../core/export.hpp"
#include "../core/math.hpp"

#include <cstddef>
#include <span>

namespace catoptric::measure {

/// Where one mirror pixel looked and where it should have, for first-order pixels.
struct LookedUp {
    double angle_degrees = 0;  ///< between the two directions, 0..180
    bool wrong_object = false; ///< the capture shows another object in the looked-up direction
    int state = 0;             ///< 0 hit, 1 unknown, 2 miss
    double residual =
        0; ///< relative distance between what the search found and what was captured there
};

/// How well a search found its directions.
struct LookupError {
    std::size_t pixels = 0;
    double mean_degrees = 0, p95_degrees = 0, p99_degrees = 0;
    double wrong_object = 0, unknown = 0, miss = 0; ///< shares of the pixels, 0..1
    double p95_residual = 0;                        ///< of hits
};

/// All zero for an empty list.
CATOPTRIC_API LookupError lookup_error(std::span<const LookedUp> pixels);

/// Angle between two directions in degrees; exact for small angles too (no acos of a cosine near
/// 1).
CATOPTRIC_API double angle_degrees(const dvec3& a, const dvec3& b);

} // namespace catoptric::measure
