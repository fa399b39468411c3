#include "measure/heat.hpp"

#include "measure/srgb.hpp"
#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace catoptric::measure {
namespace {

/// Returns the CIE lightness L* of a display colour, 0 to 100.
double cie_lightness(const vec3& display) {
    const auto linear = [](float value) { return linear_from_srgb(static_cast<double>(value)); };
    const double y = 0.2126 * linear(display.x) + 0.7152 * linear(display.y) +
                     0.0722 * linear(display.z);
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(Heat, LightnessOfHeatColoursRisesEvenly) {
    double before = -1;
    for (int i = 0; i <= 256; ++i) {
        const float value = static_cast<float>(i) / 256.0F;
        const double now = cie_lightness(heat_colour(value));
        EXPECT_GT(now, before);
        EXPECT_NEAR(now, 98 * static_cast<double>(value), 2.5) << value;
        before = now;
    }
}

TEST(Heat, HeatColoursAreClampedAtTheEndsOfTheScale) {
    EXPECT_EQ(heat_colour(0), vec3(0));
    EXPECT_EQ(heat_colour(1), vec3(0.99F, 0.99F, 0.78F));
    EXPECT_EQ(heat_colour(-1), heat_colour(0));
    EXPECT_EQ(heat_colour(7), heat_colour(1));
    EXPECT_EQ(heat_colour(std::numeric_limits<float>::infinity()), heat_colour(1));
}

TEST(Heat, NanHasAColourOutsideTheScale) {
    EXPECT_EQ(heat_colour(std::numeric_limits<float>::quiet_NaN()), vec3(0, 1, 1));
}

TEST(Heat, HeatPictureKeepsPixelOrderAndScalesValues) {
    const Picture picture = make_heat_map(std::vector<float>{0, 0.5F, 1, 2}, 2, 2, 2);
    EXPECT_EQ(picture.at(0, 0), heat_colour(0));
    EXPECT_EQ(picture.at(1, 0), heat_colour(0.25F));
    EXPECT_EQ(picture.at(0, 1), heat_colour(0.5F));
    EXPECT_EQ(picture.at(1, 1), heat_colour(1));
}

std::string heat_map_error_text(std::size_t size, float high) {
    return test::catch_error_text(catoptric::Failure::internal,
                                  [&] { make_heat_map(std::vector<float>(size), 2, 2, high); });
}

TEST(Heat, WrongMapSizeOrScaleIsRefused) {
    EXPECT_EQ(heat_map_error_text(3, 1), "a heat picture of 2x2 wants as many values, found 3");
    EXPECT_EQ(heat_map_error_text(4, 0), "a heat picture wants a top above 0, found 0");
    EXPECT_EQ(heat_map_error_text(4, std::numeric_limits<float>::quiet_NaN()),
              "a heat picture wants a top above 0, found nan");
}

} // namespace
} // namespace catoptric::measure
