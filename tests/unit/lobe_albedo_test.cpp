// Tests of the quadrature that computes the expected albedo of rough surfaces in `catoptric
// stress`.
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
            EXPECT_NEAR(stress::lobe_albedo(roughness, degrees), wanted, 5e-4)
                << "roughness " << roughness << " at " << degrees;
        }
}

/// Seen head-on, the albedo of a lobe is 1 for roughness 0, and smaller for roughness 1, because
/// masking removes light.
TEST(LobeAlbedo, FallsWithTheRoughness) {
    EXPECT_NEAR(stress::lobe_albedo(.01, 0), 1, 1e-4);
    EXPECT_LT(stress::lobe_albedo(1, 0), .6);
}

} // namespace
