#include "measure/path_distance.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::measure {

namespace {

constexpr double kPreciseShare = .25, kPreciseNoise = .01;

bool shows_mirror(const PathDistance& distance) { return !std::isnan(distance.flip); }

double headline_flip(const PathDistance& distance) {
    return shows_mirror(distance) ? distance.flip : distance.flip_all;
}

double headline_noise(const PathDistance& distance) {
    return shows_mirror(distance) ? distance.noise : distance.noise_all;
}

} // namespace

Interval distance_interval(const PathDistance& distance) {
    const double flip = headline_flip(distance), noise = headline_noise(distance);
    return {std::clamp(flip - noise, 0.0, 1.0), std::clamp(flip + noise, 0.0, 1.0)};
}

bool is_precise(const PathDistance& distance) {
    return headline_noise(distance) <=
           std::max(kPreciseShare * headline_flip(distance), kPreciseNoise);
}

} // namespace catoptric::measure
