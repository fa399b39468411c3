#pragma once

#include "core/math.hpp"

#include <cmath>
#include <numbers>

/// Independent reference for the lobe of rough surfaces: quadrature in double precision, with
/// formulas that share nothing with shaders/lib/math/lobe.glsl. Directions are in tangent space,
/// whose z axis is the normal.
namespace test {

using catoptric::dvec3;

/// Returns the reflectance times the cosine for a Fresnel reflectance of 1, with textbook formulas:
/// D by the angle of the half vector, G2 by the lambdas of Smith.
inline double textbook_lobe_reflectance(double roughness, const dvec3& o, const dvec3& i) {
    if (i.z <= 0) return 0;
    const double alpha = roughness * roughness;
    const dvec3 h = glm::normalize(o + i);
    const double cos2 = h.z * h.z, tan2 = (1 - cos2) / cos2;
    const double d = 1 / (std::numbers::pi * alpha * alpha * cos2 * cos2 *
                          std::pow(1 + tan2 / (alpha * alpha), 2));
    const auto lambda = [&](const dvec3& w) {
        const double tan2_w = (1 - w.z * w.z) / (w.z * w.z);
        return (std::sqrt(1 + alpha * alpha * tan2_w) - 1) / 2;
    };
    return d / (1 + lambda(o) + lambda(i)) / (4 * o.z);
}

/// Integrates a function of half vector and light direction over all light directions. The half
/// vectors are spaced by the width of the distribution, so that narrow lobes are resolved.
template <typename Function>
double integrate_over_half_vectors(double roughness, const dvec3& o, Function&& function) {
    constexpr int kAzimuthSteps = 512, kPolarSteps = 2048;
    const double alpha = roughness * roughness;
    double sum = 0;
    for (int k = 0; k < kPolarSteps; ++k) {
        // tan(theta) = alpha s / (1 - s) for s in (0, 1) covers all half vectors.
        const double s = (k + .5) / kPolarSteps, tangent = alpha * s / (1 - s);
        const double theta = std::atan(tangent);
        const double step = alpha / ((1 - s) * (1 - s)) / (1 + tangent * tangent) / kPolarSteps;
        for (int j = 0; j < kAzimuthSteps; ++j) {
            const double phi = 2 * std::numbers::pi * (j + .5) / kAzimuthSteps;
            const dvec3 h{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                          std::cos(theta)};
            const double cosine = glm::dot(o, h);
            if (cosine <= 0) continue;
            const dvec3 i = 2 * cosine * h - o;
            // The solid angle of light directions is 4 o.h times that of half vectors.
            const double angle = std::sin(theta) * step * 2 * std::numbers::pi / kAzimuthSteps;
            sum += function(i) * 4 * cosine * angle;
        }
    }
    return sum;
}

} // namespace test
