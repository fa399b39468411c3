// Tests of the mathematics of rough look-ups (shaders/lib/math/rough.glsl): the levels of captures,
// the distance laws, and the sample directions of the filter.
#include "core/shader_math.hpp"
#include "support/lobe_witness.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace catoptric;

TEST(RoughLevels, WidthsOfLevelsDouble) {
    // In a cube face of 256 texels, a texel in the middle covers an angle of pi / 512.
    EXPECT_DOUBLE_EQ(f64::alpha_of_capture_level(1., 256.), 4 * std::numbers::pi / 512);
    for (int level = 1; level < 8; ++level)
        EXPECT_DOUBLE_EQ(f64::alpha_of_capture_level(level + 1., 256.),
                         2 * f64::alpha_of_capture_level(double(level), 256.));
    EXPECT_DOUBLE_EQ(f64::alpha_of_capture_level(3., 512.), f64::alpha_of_capture_level(2., 256.));
}

TEST(RoughLevels, LevelIsTheInverseOfItsWidth) {
    for (const double edge : {16., 100., 256., 1024.})
        for (int level = 1; level < 6; ++level)
            EXPECT_NEAR(
                f64::capture_level_of_alpha(f64::alpha_of_capture_level(double(level), edge), edge),
                level, 1e-9)
                << edge;
    EXPECT_EQ(f64::capture_level_of_alpha(0., 256.), 0);
}

/// The mean square width of a mix of two levels is the mean of their mean square widths.
TEST(RoughLevels, MixOfTwoLevelsHasTheMeanSquareWidth) {
    const double edge = 256, first = f64::alpha_of_capture_level(1., edge);
    for (int k = 1; k < 300; ++k) {
        const double alpha = k / 300.0, level = f64::capture_level_of_alpha(alpha, edge);
        const double low = std::floor(level), share = level - low;
        const auto square = [&](double at) {
            return at < 1 ? 0 : std::pow(first * std::exp2(at - 1), 2);
        };
        EXPECT_NEAR((1 - share) * square(low) + share * square(low + 1), alpha * alpha, 1e-9)
            << alpha;
    }
}

TEST(RoughLevels, BoxesAreAsWideAsTheLobe) {
    // Finds by a search the angle at which a reflected lobe, seen head-on, has half of its largest
    // value.
    for (const double alpha : {.02, .05, .1}) {
        const auto height = [&](double angle) {
            return f64::ggx_density(alpha, dvec3(std::sin(angle / 2), 0, std::cos(angle / 2)));
        };
        double low = 0, high = 1;
        for (int k = 0; k < 60; ++k)
            (height((low + high) / 2) > height(0) / 2 ? low : high) = (low + high) / 2;
        const double level = f64::box_level_of_alpha(alpha, 256.);
        const double box = 1.5 * std::numbers::pi / 512 * std::exp2(level);
        EXPECT_NEAR(box / (2 * low), 1, .02) << alpha;
    }
    EXPECT_EQ(f64::box_level_of_alpha(1e-7, 256.), 0);
}

TEST(RoughLevels, LawsAgreeForDistantSurfaces) {
    for (const double roughness : {.05, .3, .6})
        for (std::uint32_t law = f64::kLawNone; law <= f64::kLawExact; ++law)
            EXPECT_DOUBLE_EQ(f64::lookup_alpha_by_distance_law(law, roughness, 1., 1.),
                             roughness * roughness)
                << law;
}

TEST(RoughLevels, LawsOfNearAndFarSurfaces) {
    const double r = .5;
    const auto alpha = [&](std::uint32_t law, double ratio, double foreshortening = 1) {
        return f64::lookup_alpha_by_distance_law(law, r, ratio, foreshortening);
    };
    EXPECT_DOUBLE_EQ(alpha(f64::kLawNone, .1), .25);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawFrostbite, 0), std::pow(.25, 2)); // mix(0, r, r) = r^2
    EXPECT_DOUBLE_EQ(alpha(f64::kLawFrostbite, .5), std::pow(.25 * .5 + .5 * .5, 2));
    EXPECT_DOUBLE_EQ(alpha(f64::kLawFrostbite, 3), .25);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawSquare, .2), .05);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawSquare, 3), .25);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawCone, .2), .05);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawCone, 2), .5);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawCone, 9), 1);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawExact, .5, .25), .0625);
    EXPECT_DOUBLE_EQ(alpha(f64::kLawCone, .5, .25), .125) << "ignores the slope";
}

/// The expected value is computed as follows: a narrow cone of rays is cut by a slanted plane. The
/// solid angle of the cut, as seen from the capture's centre, is summed up triangle by triangle.
TEST(RoughLevels, ExactLawIsTheSolidAngleSeenFromTheCentre) {
    const dvec3 surface(0), direction(0, 0, 1), end(0, 0, 2);
    const auto solid_angle = [](const dvec3& eye, const dvec3& a, const dvec3& b, const dvec3& c) {
        const dvec3 u = glm::normalize(a - eye), v = glm::normalize(b - eye),
                    w = glm::normalize(c - eye);
        return 2 * std::atan2(std::abs(glm::dot(u, glm::cross(v, w))),
                              1 + glm::dot(u, v) + glm::dot(v, w) + glm::dot(w, u));
    };
    for (const dvec3& normal : {dvec3(0, 0, -1), dvec3(.6, 0, -.8), dvec3(0, .9, -.436)})
        for (const dvec3& centre : {dvec3(1, 0, 1), dvec3(-.5, .7, -2), dvec3(0, 0, 1.5)}) {
            const dvec3 n = glm::normalize(normal);
            constexpr double kHalfAngleOfLobe = .01;
            constexpr int kStepsAroundNormal = 64;
            double from_surface = 0, from_centre = 0;
            const auto corner = [&](int k) {
                const double turn = 2 * std::numbers::pi * k / kStepsAroundNormal;
                const dvec3 ray(std::sin(kHalfAngleOfLobe) * std::cos(turn),
                                std::sin(kHalfAngleOfLobe) * std::sin(turn),
                                std::cos(kHalfAngleOfLobe));
                return surface + ray * (glm::dot(end - surface, n) / glm::dot(ray, n));
            };
            for (int k = 0; k < kStepsAroundNormal; ++k) {
                from_surface += solid_angle(surface, end, corner(k), corner(k + 1));
                from_centre += solid_angle(centre, end, corner(k), corner(k + 1));
            }
            const dvec3 seen = glm::normalize(end - centre);
            const double ratio = glm::length(end - surface) / glm::length(end - centre);
            const double foreshortening = std::abs(glm::dot(n, seen)) /
                                          std::abs(glm::dot(n, direction));
            const double alpha = f64::lookup_alpha_by_distance_law(f64::kLawExact, .1, ratio,
                                                                   foreshortening);
            EXPECT_NEAR(alpha * alpha / 1e-4, from_centre / from_surface,
                        .02 * from_centre / from_surface);
        }
}

/// The mean of a function over sampled directions must equal its integral over the lobe.
TEST(RoughLevels, DirectionsSeenHeadOnFollowTheLobe) {
    for (const double roughness : {.2, .5, .9}) {
        const double alpha = roughness * roughness;
        const dvec3 o(0, 0, 1);
        const auto shape = [](const dvec3& i) { return i.z > .2 ? 1 + i.x + i.z * i.y : 0; };
        const double wanted = test::integrate_over_half_vectors(
            roughness, o, [&](const dvec3& i) { // density of light directions seen head-on: D / 4
                const dvec3 h = glm::normalize(o + i);
                return shape(i) * f64::ggx_density(alpha, h) / 4;
            });
        constexpr std::uint32_t kLobeSampleCount = 1 << 14;
        double mean = 0;
        for (std::uint32_t k = 0; k < kLobeSampleCount; ++k) {
            double u, v;
            f64::hammersley_point(k, kLobeSampleCount, u, v);
            mean += shape(f64::sample_lobe_seen_head_on(alpha, u, v)) / kLobeSampleCount;
        }
        EXPECT_NEAR(mean, wanted, .003 * wanted) << roughness;
    }
}

TEST(RoughLevels, HammersleyPointsFillTheSquareEvenly) {
    std::vector<int> cells(64);
    for (std::uint32_t k = 0; k < 64; ++k) {
        double u, v;
        f64::hammersley_point(k, 64, u, v);
        ++cells[std::size_t(int(u * 8) * 8 + int(v * 8))];
    }
    EXPECT_THAT(cells, testing::Each(1));
}

TEST(RoughLevels, LobeAlbedoEqualsTheQuadrature) {
    for (const double roughness : {.1, .3, .6, 1.})
        for (const double cosine : {.1, .5, 1.}) {
            const dvec3 o(std::sqrt(1 - cosine * cosine), 0, cosine);
            const double f0 = .4;
            const double wanted = test::integrate_over_half_vectors(
                roughness, o, [&](const dvec3& i) {
                    if (i.z <= 0) return 0.0;
                    const double away = 1 - glm::dot(o, glm::normalize(o + i));
                    return (f0 + (1 - f0) * std::pow(away, 5)) *
                           test::textbook_lobe_reflectance(roughness, o, i);
                });
            double head_on, grazing;
            f64::lobe_albedo_terms(f64::roughness_to_alpha(roughness), cosine, 32, head_on,
                                   grazing);
            EXPECT_NEAR(f0 * head_on + grazing, wanted, .002) << roughness << ", " << cosine;
        }
}

} // namespace
