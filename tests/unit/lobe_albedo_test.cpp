// Tests of the quadrature with which `catoptric stress` judges rough surfaces.
#include "stress/lobe_albedo.hpp"
#include "support/lobe_witness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

using namespace catoptric;

TEST(LobeAlbedo, EqualsAQuadratureOfTheTextbookFormulas) {
    for (const double roughness : {.05, .2, .5, 1.})
        for (const double degrees : {0., 30., 80., 89.9}) {
            const double angle = degrees * std::numbers::pi / 180;
            const dvec3 o(std::sin(angle), 0, std::cos(angle));
            const double wanted = test::integrate_over_half_vectors(
                roughness, o,
                [&](const dvec3& i) { return test::textbook_lobe_reflectance(roughness, o, i); });
            EXPECT_NEAR(stress::compute_lobe_albedo(roughness, degrees), wanted, 5e-4)
                << "roughness " << roughness << " at " << degrees;
        }
}

/// Head-on, the albedo of a lobe with roughness 0 is 1. With roughness 1, masking takes light.
TEST(LobeAlbedo, FallsWithTheRoughness) {
    EXPECT_NEAR(stress::compute_lobe_albedo(.01, 0), 1, 1e-4);
    EXPECT_LT(stress::compute_lobe_albedo(1, 0), .6);
}

} // namespace
