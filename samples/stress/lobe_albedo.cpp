#include "stress/lobe_albedo.hpp"

#include "core/math.hpp"

#include <cmath>
#include <numbers>

namespace catoptric::stress {

namespace {

/// Returns Smith's Lambda: the area of microfacets that hide others from a direction, over the area
/// that the direction sees. `z` is the cosine between the direction and the normal.
double smith_lambda(double alpha, double z) {
    const double slope = alpha * std::sqrt(1 / (z * z) - 1);
    return (std::sqrt(1 + slope * slope) - 1) / 2;
}

} // namespace

double lobe_albedo(double roughness, double degrees) {
    constexpr int kMicrofacetSlopeSteps = 512, kTurnSteps = 512;
    const double alpha = roughness * roughness, angle = degrees * std::numbers::pi / 180;
    const dvec3 to_eye(std::sin(angle), 0, std::cos(angle));
    double sum = 0;
    for (int k = 0; k < kMicrofacetSlopeSteps; ++k) {
        // Slopes of the microfacets from 0 to infinity, in units of alpha.
        const double s = (k + .5) / kMicrofacetSlopeSteps, slope = s / (1 - s);
        const double density = 2 * slope / std::pow(1 + slope * slope, 2);
        const double share = density / ((1 - s) * (1 - s)) / kMicrofacetSlopeSteps / kTurnSteps;
        for (int j = 0; j < kTurnSteps; ++j) {
            const double turn = std::numbers::pi * (j + .5) / kTurnSteps; // the lobe is symmetric
            const dvec3 facet = normalize(
                dvec3(alpha * slope * std::cos(turn), alpha * slope * std::sin(turn), 1));
            const double cosine = dot(to_eye, facet);
            const dvec3 to_light = 2 * cosine * facet - to_eye;
            if (cosine <= 0 || to_light.z <= 0) continue;
            const double seen_area = cosine / (facet.z * to_eye.z);
            sum += share * seen_area /
                   (1 + smith_lambda(alpha, to_eye.z) + smith_lambda(alpha, to_light.z));
        }
    }
    return sum;
}

} // namespace catoptric::stress
