// Tests of the specular lobe of rough surfaces (shaders/lib/math/lobe.glsl). Expected values come
// from an integrator in double precision with independent formulas.
#include "core/shader_math.hpp"
#include "support/lobe_witness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace {

using namespace catoptric;

constexpr double kTestedRoughnesses[] = {.05, .15, .3, .5, .8, 1};

dvec3 direction_at_angles(double degrees, double turn = 0) {
    const double angle = degrees * std::numbers::pi / 180;
    return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

double lobe_albedo_by_quadrature(double roughness, const dvec3& o) {
    return test::integrate_over_half_vectors(roughness, o, [&](const dvec3& i) {
        return test::textbook_lobe_reflectance(roughness, o, i);
    });
}

TEST(Lobe, EqualsTheTextbookFormulas) {
    std::mt19937_64 random(3);
    const auto draw = [&] { return double(random() >> 11) * 0x1p-53; };
    for (int k = 0; k < 2000; ++k) {
        const double roughness = .05 + .95 * draw();
        const dvec3 o = direction_at_angles(89 * draw()),
                    i = direction_at_angles(89 * draw(), 6.28 * draw());
        const double wanted = test::textbook_lobe_reflectance(roughness, o, i);
        const double alpha = f64::roughness_to_alpha(roughness);
        EXPECT_NEAR(f64::evaluate_lobe(alpha, dvec3(1), dvec3(1), o, i).x, wanted, 1e-9 * wanted);
        const float in_float = f32::evaluate_lobe(float(alpha), f32::vec3(1), f32::vec3(1),
                                                  f32::vec3(o), f32::vec3(i))
                                   .x;
        EXPECT_NEAR(in_float, wanted, 2e-4 * wanted + 1e-12) << roughness;
    }
}

TEST(Lobe, DensityAtTheNormalIsKnown) {
    EXPECT_DOUBLE_EQ(f64::ggx_density(.25, dvec3(0, 0, 1)), 16 / std::numbers::pi);
    EXPECT_DOUBLE_EQ(f64::roughness_to_alpha(.5), .25);
}

TEST(Lobe, IsReciprocal) {
    const dvec3 a = direction_at_angles(70), b = direction_at_angles(20, 2);
    for (const double roughness : kTestedRoughnesses) {
        const double alpha = f64::roughness_to_alpha(roughness);
        const double there = f64::evaluate_lobe(alpha, dvec3(.9), dvec3(1), a, b).x / b.z;
        const double back = f64::evaluate_lobe(alpha, dvec3(.9), dvec3(1), b, a).x / a.z;
        EXPECT_NEAR(there, back, 1e-12 * there) << roughness;
    }
}

TEST(Lobe, FresnelReflectanceGoesFromF0ToF90) {
    const dvec3 up(0, 0, 1);
    const double white = f64::evaluate_lobe(.1, dvec3(1), dvec3(1), up, up).x;
    EXPECT_NEAR(f64::evaluate_lobe(.1, dvec3(.04), dvec3(1), up, up).x, .04 * white, 1e-12 * white);
    const dvec3 o = direction_at_angles(89.9), i = direction_at_angles(89.9, std::numbers::pi);
    const double grazing = f64::evaluate_lobe(.1, dvec3(1), dvec3(1), o, i).x;
    EXPECT_NEAR(f64::evaluate_lobe(.1, dvec3(.04), dvec3(1), o, i).x, grazing, .02 * grazing);
}

TEST(Lobe, LightBelowTheSurfaceGivesNothing) {
    const dvec3 below = direction_at_angles(100);
    EXPECT_EQ(f64::evaluate_lobe(.2, dvec3(1), dvec3(1), direction_at_angles(30), below).x, 0);
    EXPECT_EQ(f64::evaluate_lobe(.2, dvec3(1), dvec3(1), below, direction_at_angles(30)).x, 0);
    EXPECT_EQ(f64::lobe_sample_weight(.2, dvec3(1), dvec3(1), direction_at_angles(30), below).x, 0);
}

/// Sums the values of a function over stratified samples of the lobe.
template <typename Function>
void sum_over_lobe_samples(double alpha, const dvec3& o, int across, Function&& function) {
    for (int a = 0; a < across; ++a)
        for (int b = 0; b < across; ++b)
            function(f64::sample_lobe(alpha, o, (a + .5) / across, (b + .5) / across));
}

/// The mean weight of samples is the share of light that a surface with reflectance 1 reflects in a
/// white furnace. The test fails if the density lacks the factor of the bound, if a masking term is
/// missing, or if the roughness is squared once too often.
TEST(Lobe, MeanWeightOfSamplesIsTheAlbedoByQuadrature) {
    constexpr int kSamplesAcrossLobe = 512;
    for (const double roughness : kTestedRoughnesses)
        for (const double degrees : {0., 30., 60., 80., 88.}) {
            const dvec3 o = direction_at_angles(degrees);
            const double alpha = f64::roughness_to_alpha(roughness);
            double sum = 0;
            sum_over_lobe_samples(alpha, o, kSamplesAcrossLobe, [&](const dvec3& i) {
                sum += f64::lobe_sample_weight(alpha, dvec3(1), dvec3(1), o, i).x;
            });
            EXPECT_NEAR(sum / (kSamplesAcrossLobe * kSamplesAcrossLobe),
                        lobe_albedo_by_quadrature(roughness, o), .002)
                << roughness << " at " << degrees;
        }
}

TEST(Lobe, WeightIsTheLobeDividedByTheDensity) {
    for (const double roughness : kTestedRoughnesses) {
        const dvec3 o = direction_at_angles(65);
        const double alpha = f64::roughness_to_alpha(roughness);
        sum_over_lobe_samples(alpha, o, 32, [&](const dvec3& i) {
            if (i.z <= 0) return;
            const double weight = f64::lobe_sample_weight(alpha, dvec3(.5), dvec3(1), o, i).x;
            EXPECT_NEAR(weight * f64::lobe_pdf(alpha, o, i),
                        f64::evaluate_lobe(alpha, dvec3(.5), dvec3(1), o, i).x,
                        1e-8 * weight * f64::lobe_pdf(alpha, o, i));
        });
    }
}

/// One half of the hemisphere beside the plane of reflection, and a cone around the mirror
/// direction, must each get as many samples as the density predicts.
TEST(Lobe, SamplesFallWhereTheDensitySaysSo) {
    constexpr int kSamplesAcrossLobe = 512;
    for (const double roughness : {.15, .5, 1.})
        for (const double degrees : {10., 60., 85.}) {
            const dvec3 o = direction_at_angles(degrees);
            const dvec3 mirror(-o.x, -o.y, o.z);
            const double alpha = f64::roughness_to_alpha(roughness);
            for (const double cosine : {.999, .95, .7}) {
                const auto is_inside = [&](const dvec3& i) {
                    return i.z > 0 && glm::dot(i, mirror) > cosine;
                };
                double found = 0;
                sum_over_lobe_samples(alpha, o, kSamplesAcrossLobe,
                                      [&](const dvec3& i) { found += is_inside(i); });
                const double wanted = test::integrate_over_half_vectors(
                    roughness, o,
                    [&](const dvec3& i) { return is_inside(i) ? f64::lobe_pdf(alpha, o, i) : 0; });
                EXPECT_NEAR(found / (kSamplesAcrossLobe * kSamplesAcrossLobe), wanted, .004)
                    << roughness << " at " << degrees << ", cone " << cosine;
            }
        }
}

/// The bounded distribution of visible normals exists to avoid samples below the surface, so only
/// few samples may lie there.
TEST(Lobe, FewSamplesLieBelowTheSurface) {
    int below = 0;
    sum_over_lobe_samples(1, direction_at_angles(80), 128,
                          [&](const dvec3& i) { below += i.z <= 0; });
    EXPECT_LT(below, 128 * 128 * .05);
}

TEST(Lobe, RoughnessZeroIsAPerfectMirror) {
    for (const double degrees : {0., 45., 89.9})
        for (const float roughness : {0.f, 1e-8f, 1e-4f}) {
            const f32::vec3 o(direction_at_angles(degrees));
            const float alpha = f32::roughness_to_alpha(roughness);
            for (const float u : {0.f, .3f, .999f})
                for (const float v : {0.f, .5f, .99f}) {
                    const f32::vec3 i = f32::sample_lobe(alpha, o, u, v);
                    EXPECT_LT(glm::length(i - f32::vec3(-o.x, -o.y, o.z)), 1e-3f);
                    const float weight =
                        f32::lobe_sample_weight(alpha, f32::vec3(1), f32::vec3(1), o, i).x;
                    EXPECT_NEAR(weight, 1, 1e-3) << degrees << " " << roughness;
                }
        }
}

TEST(Lobe, ExtremesGiveFiniteNumbers) {
    for (const double degrees : {0., 89.9, 89.9999})
        for (const float roughness : {0.f, 1e-8f, .04f, 1.f})
            for (const float u : {0.f, .25f, .9999999f})
                for (const float v : {0.f, .5f, .9999999f}) {
                    const f32::vec3 o(direction_at_angles(degrees));
                    const float alpha = f32::roughness_to_alpha(roughness);
                    const f32::vec3 i = f32::sample_lobe(alpha, o, u, v);
                    EXPECT_TRUE(f32::is_finite(i));
                    EXPECT_TRUE(f32::is_finite(
                        f32::lobe_sample_weight(alpha, f32::vec3(.9f), f32::vec3(1), o, i)));
                    EXPECT_FALSE(std::isnan(f32::lobe_pdf(alpha, o, i)));
                }
}

} // namespace
