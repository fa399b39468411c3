#include "measure/picture.hpp"

#include "measure/srgb.hpp"
#include "support/special_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace catoptric::measure {
namespace {

float display_value_of_linear(float linear, double stops = 0) {
    Picture picture(1, 1);
    picture.at(0, 0) = vec3(linear);
    return to_display(picture, stops).at(0, 0).x;
}

TEST(ToDisplay, DisplayValuesFollowTheSrgbCurve) {
    EXPECT_EQ(display_value_of_linear(0), 0.0F);
    EXPECT_EQ(display_value_of_linear(1), 1.0F);
    EXPECT_EQ(display_value_of_linear(0.5F),
              188.0F / 255); // sRGB: 1.055 * 0.5^(1/2.4) - 0.055 = 0.7354
    EXPECT_EQ(display_value_of_linear(0.18F),
              118.0F / 255); // sRGB: 1.055 * 0.18^(1/2.4) - 0.055 = 0.4614
    EXPECT_EQ(display_value_of_linear(0.002F), 7.0F / 255); // sRGB: 12.92 * 0.002 = 0.0258
}

TEST(ToDisplay, ValuesOutOfRangeAreClampedAndNanBecomesBlack) {
    EXPECT_EQ(display_value_of_linear(-3), 0.0F);
    EXPECT_EQ(display_value_of_linear(17), 1.0F);
    EXPECT_EQ(display_value_of_linear(test::kFloatInfinity), 1.0F);
    EXPECT_EQ(display_value_of_linear(-test::kFloatInfinity), 0.0F);
    EXPECT_EQ(display_value_of_linear(test::kFloatNan), 0.0F);
}

TEST(ToDisplay, ExposureOfOneStopDoublesTheLight) {
    EXPECT_EQ(display_value_of_linear(0.25F, 1), display_value_of_linear(0.5F));
    EXPECT_EQ(display_value_of_linear(0.5F, -1), display_value_of_linear(0.25F));
    EXPECT_EQ(display_value_of_linear(0.25F, 3), 1.0F);
}

TEST(ToDisplay, EveryByteSurvivesSrgbDecodingAndEncoding) {
    for (int byte = 0; byte < 256; ++byte) {
        const auto linear = static_cast<float>(linear_from_srgb(byte / 255.0));
        EXPECT_EQ(display_value_of_linear(linear), static_cast<float>(byte) / 255.0F);
    }
}

TEST(ToDisplay, EachChannelAndPixelIsConvertedSeparately) {
    Picture picture(2, 1);
    picture.at(0, 0) = vec3(1, 0, 0.5F);
    picture.at(1, 0) = vec3(0, 1, 0);
    const Picture display = to_display(picture);
    EXPECT_EQ(display.width, 2);
    EXPECT_EQ(display.height, 1);
    EXPECT_EQ(display.at(0, 0), vec3(1, 0, 188.0F / 255));
    EXPECT_EQ(display.at(1, 0), vec3(0, 1, 0));
}

TEST(Srgb, LinearAndPowerPartsOfTheSrgbCurveMeet) {
    EXPECT_NEAR(srgb_from_linear(0.0031308), srgb_from_linear(0.0031309), 2e-6);
    EXPECT_NEAR(linear_from_srgb(0.04045), linear_from_srgb(0.0404501), 2e-7);
}

} // namespace
} // namespace catoptric::measure
