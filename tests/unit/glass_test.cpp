// Tests of light at a surface of glass (shaders/lib/math/glass.glsl).
#include "core/shader_math.hpp"
#include "support/numbers.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <numbers>

namespace {

using namespace catoptric;

double reflected_share_of_glass(double cosine, double ratio) {
    double behind;
    return f64::fresnel_dielectric(cosine, ratio, behind);
}

TEST(Glass, ReflectsTheTextbookShares) {
    for (const double ior : {1.0, 1.33, 1.5, 2.4}) {
        EXPECT_NEAR(reflected_share_of_glass(1, ior), std::pow((ior - 1) / (ior + 1), 2), 1e-15);
        EXPECT_NEAR(reflected_share_of_glass(1, 1 / ior), std::pow((ior - 1) / (ior + 1), 2),
                    1e-15);
        // At Brewster's angle, whose tangent is the index of refraction, only light polarised
        // across the plane of incidence is reflected.
        const double brewster = std::atan(ior), across = std::cos(2 * brewster);
        EXPECT_NEAR(reflected_share_of_glass(std::cos(brewster), ior), across * across / 2, 1e-12);
    }
    EXPECT_NEAR(reflected_share_of_glass(0, 1.5), 1, 1e-12);
    EXPECT_NEAR(reflected_share_of_glass(std::cos(.8), 1), 0, 1e-15)
        << "equal media reflect nothing";
}

TEST(Glass, ReflectsAllLightBeyondTheCriticalAngle) {
    const double critical = std::asin(1 / 1.5);
    EXPECT_EQ(reflected_share_of_glass(std::cos(critical + 1e-6), 1 / 1.5), 1);
    EXPECT_LT(reflected_share_of_glass(std::cos(critical - 1e-3), 1 / 1.5), 1);
}

/// A slab of glass reflects the same share of a ray on its way in and on its way out. The ray
/// leaves the slab in the direction in which it entered.
TEST(Glass, SlabGivesBackDirectionAndShare) {
    test::RandomNumbers numbers(3);
    for (int k = 0; k < 1000; ++k) {
        const float ior = 1 + 2 * numbers.random_unit_fraction(),
                    angle = 1.5f * numbers.random_unit_fraction();
        const vec3 direction(std::sin(angle), 0, -std::cos(angle)), normal(0, 0, 1);
        float behind, outside;
        const float in = f32::fresnel_dielectric(std::cos(angle), ior, behind);
        const vec3 inner = f32::refract_direction(direction, normal, std::cos(angle), ior, behind);
        EXPECT_NEAR(inner.x * ior, direction.x, 1e-5) << "Snell's law";
        const float out = f32::fresnel_dielectric(-inner.z, 1 / ior, outside);
        const vec3 outer = f32::refract_direction(inner, normal, -inner.z, 1 / ior, outside);
        EXPECT_NEAR(in, out, 2e-4) << ior << " " << angle;
        EXPECT_LT(glm::length(outer - direction), 1e-5) << ior << " " << angle;
    }
}

/// Shares of the light that a rough surface of glass reflects and lets pass.
struct RoughGlassShares {
    double reflected = 0, passing = 0;
};

/// Integrates textbook formulas over all microfacets: Walter et al. 2007, equations 20 and 21.
RoughGlassShares integrate_rough_glass(double roughness, const dvec3& o, double ratio) {
    constexpr int kAzimuthSteps = 96, kPolarSteps = 8192;
    const double alpha = roughness * roughness;
    const auto lambda = [&](double z) {
        return (std::sqrt(1 + alpha * alpha * (1 - z * z) / (z * z)) - 1) / 2;
    };
    RoughGlassShares sum;
    for (int k = 0; k < kPolarSteps; ++k) {
        // Angles of GGX facets that divide the distribution D, weighted by the cosine, into equal
        // shares.
        const double share = (k + .5) / kPolarSteps,
                     tilt = std::atan(alpha * std::sqrt(share / (1 - share)));
        for (int j = 0; j < kAzimuthSteps; ++j) {
            const double turn = 2 * std::numbers::pi * (j + .5) / kAzimuthSteps;
            const dvec3 h(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                          std::cos(tilt));
            const double cosine = glm::dot(o, h);
            if (cosine <= 0) continue;
            const double sine_behind = std::sqrt(1 - cosine * cosine) / ratio;
            double fresnel = 1, behind = 0;
            if (sine_behind < 1) {
                behind = std::sqrt(1 - sine_behind * sine_behind);
                const double s = (cosine - ratio * behind) / (cosine + ratio * behind),
                             p = (ratio * cosine - behind) / (ratio * cosine + behind);
                fresnel = (s * s + p * p) / 2;
            }
            const double facets = cosine / h.z / o.z / (kPolarSteps * kAzimuthSteps);
            const dvec3 mirrored = 2 * cosine * h - o;
            if (mirrored.z > 0)
                sum.reflected += facets * fresnel / (1 + lambda(o.z) + lambda(mirrored.z));
            const dvec3 bent = -o / ratio + (cosine / ratio - behind) * h;
            if (fresnel < 1 && bent.z < 0)
                sum.passing += facets * (1 - fresnel) / (1 + lambda(o.z)) / (1 + lambda(-bent.z));
        }
    }
    return sum;
}

/// The mean weight of sampled microfacets must equal the integral. The test fails if a masking term
/// is missing or on the wrong side, or if normals are sampled from another distribution than that
/// of visible normals.
TEST(RoughGlass, DrawnFacetsGiveTheSharesByQuadrature) {
    constexpr int kSamplesAcross = 320;
    double least = 1;
    for (const double roughness : {.1, .3, .6, 1.})
        for (const double degrees : {0., 40., 75.})
            for (const double ratio : {1.5, 1 / 1.5}) {
                const double angle = degrees * std::numbers::pi / 180;
                const dvec3 o(std::sin(angle), 0, std::cos(angle)), up(0, 0, 1);
                const double alpha = f64::roughness_to_alpha(roughness);
                RoughGlassShares found;
                for (int k = 0; k < kSamplesAcross * kSamplesAcross; ++k) {
                    const dvec3 h = f64::sample_visible_normal(
                        alpha, o, 1., (k % kSamplesAcross + .5) / kSamplesAcross,
                        (k / kSamplesAcross + .5) / kSamplesAcross);
                    const double cosine = glm::dot(o, h);
                    double behind;
                    const double fresnel = f64::fresnel_dielectric(cosine, ratio, behind);
                    found.reflected += fresnel * f64::unblocked_reflected_share(
                                                     alpha, o.z, 2 * cosine * h.z - o.z);
                    if (fresnel < 1)
                        found.passing +=
                            (1 - fresnel) *
                            f64::unblocked_passing_share(
                                alpha, -f64::refract_direction(-o, h, cosine, ratio, behind).z);
                }
                found.reflected /= kSamplesAcross * kSamplesAcross;
                found.passing /= kSamplesAcross * kSamplesAcross;
                const RoughGlassShares wanted = integrate_rough_glass(roughness, o, ratio);
                EXPECT_NEAR(found.reflected, wanted.reflected, .002) << roughness << ' ' << degrees;
                EXPECT_NEAR(found.passing, wanted.passing, .002) << roughness << ' ' << degrees;
                EXPECT_LE(found.reflected + found.passing, 1 + 1e-9);
                if (roughness <= .3 && degrees <= 40)
                    least = std::min(least, found.reflected + found.passing);
            }
    std::cout << "[ MEASURED ] least sum: " << least << '\n';
    EXPECT_GT(least, .97) << "single scattering loses little light up to a roughness of .3";
}

} // namespace
