// Tests of light at a smooth surface of glass (shaders/lib/math/glass.glsl).
#include "core/shader_math.hpp"
#include "support/numbers.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace {

using namespace catoptric;

double reflected_share(double cosine, double ratio) {
    double behind;
    return f64::fresnel_dielectric(cosine, ratio, behind);
}

TEST(Glass, ReflectsTheTextbookShares) {
    for (const double ior : {1.0, 1.33, 1.5, 2.4}) {
        EXPECT_NEAR(reflected_share(1, ior), std::pow((ior - 1) / (ior + 1), 2), 1e-15);
        EXPECT_NEAR(reflected_share(1, 1 / ior), std::pow((ior - 1) / (ior + 1), 2), 1e-15);
        // At Brewster's angle, tan = ior, only light polarised across the plane is reflected.
        const double brewster = std::atan(ior), across = std::cos(2 * brewster);
        EXPECT_NEAR(reflected_share(std::cos(brewster), ior), across * across / 2, 1e-12);
    }
    EXPECT_NEAR(reflected_share(0, 1.5), 1, 1e-12);
    EXPECT_NEAR(reflected_share(std::cos(.8), 1), 0, 1e-15) << "equal media reflect nothing";
}

TEST(Glass, ReflectsAllLightBeyondTheCriticalAngle) {
    const double critical = std::asin(1 / 1.5);
    EXPECT_EQ(reflected_share(std::cos(critical + 1e-6), 1 / 1.5), 1);
    EXPECT_LT(reflected_share(std::cos(critical - 1e-3), 1 / 1.5), 1);
}

/// A ray reflects the same share on its way in and on its way out, and leaves a slab in the
/// direction in which it entered.
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

} // namespace
