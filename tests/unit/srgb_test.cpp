// Tests that the tables of the sRGB curve return the same values as the formula.
#include "measure/srgb.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace catoptric::measure {
namespace {

float srgb_code_by_exact_formula(double linear) {
    return static_cast<float>(std::round(srgb_from_linear(linear) * 255) / 255);
}

TEST(Srgb, EightBitTableAgreesWithTheFormula) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> even(0, 1), exponent(-40, 0);
    for (int i = 0; i < 200'000; ++i)
        for (const double linear : {even(random), std::exp2(exponent(random))})
            ASSERT_EQ(rounded_srgb(linear), srgb_code_by_exact_formula(linear)) << linear;
    EXPECT_EQ(rounded_srgb(0), 0.F);
    EXPECT_EQ(rounded_srgb(1), 1.F);
}

// Tests the values at which the 8-bit code changes, and the doubles just below and above.
TEST(Srgb, EightBitTableChangesCodeWhereTheFormulaDoes) {
    for (int code = 0; code < 255; ++code) {
        const double middle = linear_from_srgb((code + .5) / 255);
        for (double linear : {middle, std::nextafter(middle, 0.0), std::nextafter(middle, 1.0),
                              middle * (1 - 1e-9), middle * (1 + 1e-9)})
            EXPECT_EQ(rounded_srgb(linear), srgb_code_by_exact_formula(linear)) << code;
    }
}

TEST(Srgb, LinearTableAgreesWithTheFormula) {
    constexpr SrgbDecodeTable kSrgbDecodeTable;
    for (int code = 0; code < 256; ++code)
        for (const float srgb : {static_cast<float>(code / 255.0),
                                 std::min(1.F, static_cast<float>((code + .3) / 255))})
            EXPECT_EQ(kSrgbDecodeTable(srgb), linear_from_srgb(static_cast<double>(srgb))) << code;
}

} // namespace
} // namespace catoptric::measure
