#include "measure/flip.hpp"

#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace catoptric::measure {
namespace {

// The formulas of the test pictures equal those of tests/golden/flip_reference.py, which explains
// them. That script printed the figures in kFlipTestCases.
using TestPictureFormula = int (*)(int x, int y, int c, bool b);

int scrambled_pixel(int x, int y, int c, unsigned seed) {
    unsigned h = static_cast<unsigned>(x) * 374761393U + static_cast<unsigned>(y) * 668265263U +
                 static_cast<unsigned>(c) * 974634777U + seed * 2246822519U;
    h = (h ^ (h >> 13)) * 1274126177U;
    return static_cast<int>((h ^ (h >> 16)) & 255U);
}

int constant_pixel(int, int, int c, bool b) {
    constexpr std::array<int, 3> kTriangleCornerA = {200, 60, 30};
    constexpr std::array<int, 3> kB = {190, 80, 40};
    return (b ? kB : kTriangleCornerA)[static_cast<std::size_t>(c)];
}
int edge_pattern_pixel(int x, int y, int, bool b) { return x + y / 2 < (b ? 25 : 22) ? 40 : 220; }
int point_pattern_pixel(int x, int y, int, bool b) {
    return x % 8 == 4 && y % 8 == 4 && !b ? 255 : 128;
}
int noise_pattern_pixel(int x, int y, int c, bool b) { return scrambled_pixel(x, y, c, b ? 2 : 1); }
int natural_pattern_pixel(int x, int y, int c, bool b) {
    const int from_centre = x - (b ? 32 : 30);
    const bool ball = from_centre * from_centre + (y - 20) * (y - 20) < 144;
    const int value = 30 + 2 * x + 10 * c + (ball ? 70 - 30 * c : 0) +
                      scrambled_pixel(x, y, c, 3) % 16;
    return std::min(255, value - (b && c == 2 ? 8 : 0));
}
int primary_colour_pixel(int, int, int c, bool b) { return c == (b ? 2 : 1) ? 255 : 0; }

Picture make_picture_of_formula(TestPictureFormula formula, int width, int height, bool b) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                picture.at(x, y)[c] = static_cast<float>(formula(x, y, c, b)) / 255.0F;
    return picture;
}

struct FlipTestCase {
    TestPictureFormula formula;
    int width, height;
    double pixels_per_degree;
    double mean;
    std::array<double, 5> pixels;
};
constexpr std::array<std::array<double, 2>, 5> kPublishedPixelPlaces = {
    {{0, 0}, {0.5, 0.5}, {0.3, 0.7}, {0.9, 0.1}, {0.999, 0.999}}};
const FlipTestCase kFlipTestCases[] = {
    // The expected figures come from flip-evaluator 1.7, the program of FLIP's authors.
    {constant_pixel,
     24,
     16,
     67,
     0.2156905,
     {0.2156905, 0.2156905, 0.2156905, 0.2156905, 0.2156905}},
    {edge_pattern_pixel,
     40,
     30,
     67,
     0.1488630,
     {0.0000000, 0.1508427, 0.9661281, 0.0000000, 0.0000000}},
    {point_pattern_pixel,
     32,
     24,
     67,
     0.0653677,
     {0.0000576, 0.0071267, 0.0004929, 0.1244844, 0.0021309}},
    {noise_pattern_pixel,
     33,
     21,
     67,
     0.4316227,
     {0.5222005, 0.4762466, 0.3012399, 0.3117291, 0.6648194}},
    {natural_pattern_pixel,
     64,
     48,
     67,
     0.1401119,
     {0.0755432, 0.1352261, 0.1119139, 0.1328537, 0.1346985}},
    {primary_colour_pixel,
     9,
     7,
     67,
     1.0000000,
     {1.0000000, 1.0000000, 1.0000000, 1.0000000, 1.0000000}},
    {natural_pattern_pixel,
     50,
     1,
     67,
     0.1030659,
     {0.0756613, 0.1061340, 0.0944556, 0.1233173, 0.1225968}},
    {natural_pattern_pixel,
     1,
     1,
     67,
     0.0730469,
     {0.0730469, 0.0730469, 0.0730469, 0.0730469, 0.0730469}},
    {natural_pattern_pixel,
     64,
     48,
     20,
     0.1337787,
     {0.0746789, 0.1239210, 0.0971719, 0.1310261, 0.1344866}},
    {natural_pattern_pixel,
     64,
     48,
     150,
     0.1438341,
     {0.0776868, 0.1680495, 0.1197986, 0.1379943, 0.1346316}},
};

Picture crop_picture(const Picture& picture, int left, int top, int width, int height) {
    Picture part(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) part.at(x, y) = picture.at(left + x, top + y);
    return part;
}

// FLIP is computed in tiles, and the borders of tiles must not change the result.
TEST(Flip, PixelErrorDependsOnlyOnPixelsWithinReach) {
    constexpr int kPublishedPictureWidth = 620, kHeight = 310, kLeft = 117, kTop = 23;
    const Picture a = make_picture_of_formula(noise_pattern_pixel, kPublishedPictureWidth, kHeight,
                                              false),
                  b = make_picture_of_formula(noise_pattern_pixel, kPublishedPictureWidth, kHeight,
                                              true);
    const int width = kPublishedPictureWidth - 2 * kLeft, height = kHeight - 2 * kTop,
              reach = flip_filter_radius();
    const std::vector<float> whole = flip(a, b),
                             part = flip(crop_picture(a, kLeft, kTop, width, height),
                                         crop_picture(b, kLeft, kTop, width, height));
    for (int y = reach; y < height - reach; ++y)
        for (int x = reach; x < width - reach; ++x)
            ASSERT_EQ(
                part[static_cast<std::size_t>(y * width + x)],
                whole[static_cast<std::size_t>((y + kTop) * kPublishedPictureWidth + x + kLeft)])
                << x << ", " << y;
}

class PublishedFlipTest : public testing::TestWithParam<FlipTestCase> {};

TEST_P(PublishedFlipTest, MapAndMeanEqualThoseOfFlipEvaluator) {
    const FlipTestCase& wanted = GetParam();
    const Picture a = make_picture_of_formula(wanted.formula, wanted.width, wanted.height, false);
    const Picture b = make_picture_of_formula(wanted.formula, wanted.width, wanted.height, true);
    const std::vector<float> map = flip(a, b, wanted.pixels_per_degree);
    // The program of FLIP's authors works in float, ours in double. In flat pictures, a square root
    // turns their rounding of 1e-8 into a feature difference of 1e-4 and an error of 3e-5.
    EXPECT_NEAR(flip_mean(map), wanted.mean, wanted.formula == constant_pixel ? 3e-5 : 1e-5);
    for (std::size_t i = 0; i < kPublishedPixelPlaces.size(); ++i) {
        const int x = static_cast<int>(kPublishedPixelPlaces[i][0] * wanted.width);
        const int y = static_cast<int>(kPublishedPixelPlaces[i][1] * wanted.height);
        EXPECT_NEAR(map[static_cast<std::size_t>(y * wanted.width + x)], wanted.pixels[i], 1e-4)
            << x << " " << y;
    }
}

INSTANTIATE_TEST_SUITE_P(Flip, PublishedFlipTest, testing::ValuesIn(kFlipTestCases));

/// Builds a picture of linear values between the steps of 8 bits. flip_reference.py uses the same
/// formula.
Picture make_picture_between_byte_steps(bool b) {
    Picture picture(40, 24);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            for (int c = 0; c < 3; ++c)
                picture.at(x, y)[c] = static_cast<float>(
                    (20 + 3 * x + 2 * y + 5 * c + (b ? x * y % 7 / 16.0 : 0)) / 255);
    return picture;
}

TEST(Flip, FlipOfUnroundedFloatsEqualsThatOfFlipEvaluator) {
    const Picture a = make_picture_between_byte_steps(false),
                  b = make_picture_between_byte_steps(true);
    const auto mean = [&](auto&& display, double stops) {
        return flip_mean(flip(display(a, stops), display(b, stops)));
    };
    // The expected figures come from flip-evaluator 1.7, the program of FLIP's authors.
    EXPECT_NEAR(mean(to_unrounded_display, -.5), .0062926, 2e-5);
    EXPECT_NEAR(mean(to_unrounded_display, .5), .0076279, 2e-5);
    EXPECT_NEAR(mean(to_display, -.5), .0074952, 2e-5);
    EXPECT_NEAR(mean(to_display, .5), .0102913, 2e-5);
}

TEST(Flip, EqualPicturesGiveExactlyZero) {
    const Picture a = make_picture_of_formula(noise_pattern_pixel, 20, 20, false);
    for (const float error : flip(a, a)) EXPECT_EQ(error, 0.0F);
}

TEST(Flip, FlipIsSymmetric) {
    const Picture a = make_picture_of_formula(natural_pattern_pixel, 40, 30, false);
    const Picture b = make_picture_of_formula(natural_pattern_pixel, 40, 30, true);
    EXPECT_EQ(flip(a, b), flip(b, a));
}

TEST(Flip, MirroredPicturesGiveTheMirroredMap) {
    const auto mirrored = [](const Picture& picture) {
        Picture result(picture.width, picture.height);
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                result.at(picture.width - 1 - x, y) = picture.at(x, y);
        return result;
    };
    const Picture a = make_picture_of_formula(natural_pattern_pixel, 40, 30, false);
    const Picture b = make_picture_of_formula(natural_pattern_pixel, 40, 30, true);
    const std::vector<float> map = flip(a, b);
    const std::vector<float> other = flip(mirrored(a), mirrored(b));
    for (std::size_t y = 0; y < 30; ++y)
        for (std::size_t x = 0; x < 40; ++x)
            EXPECT_NEAR(map[y * 40 + x], other[y * 40 + 39 - x], 1e-6);
}

TEST(Flip, FlatPicturesDifferEquallyAtEveryViewingDistance) {
    // A flat picture has no features and nothing to blur. The error is therefore the colour
    // difference of the `constant_pixel` case.
    for (const double pixels_per_degree : {1.0, 20.0, 67.0, 300.0})
        for (const float error :
             flip(make_picture_of_formula(constant_pixel, 12, 9, false),
                  make_picture_of_formula(constant_pixel, 12, 9, true), pixels_per_degree))
            EXPECT_NEAR(error, 0.2156905, 1e-4);
}

TEST(Flip, ErrorOfBlackAgainstWhiteIsNearlyOne) {
    Picture white(8, 8);
    for (vec3& pixel : white.pixels) pixel = vec3(1);
    const double mean = flip_mean(flip(Picture(8, 8), white));
    EXPECT_GT(mean, 0.95);
    EXPECT_LE(mean, 1);
}

TEST(Flip, MeanCountsOnlyPixelsOfTheMask) {
    const std::vector<float> map = {0.5F, 1, 0.25F, 0};
    EXPECT_EQ(flip_mean(map), 0.4375);
    EXPECT_EQ(flip_mean(map, {1, 0, 255, 0}), 0.375);
    EXPECT_TRUE(std::isnan(flip_mean(map, {0, 0, 0, 0})));
    EXPECT_THROW(flip_mean(map, {1, 0}), Error);
}

std::string flip_error_text(catoptric::Failure failure, int width_a, int height_a, int width_b,
                            int height_b, double ppd = 67) {
    return test::catch_error_text(
        failure, [&] { flip(Picture(width_a, height_a), Picture(width_b, height_b), ppd); });
}

TEST(Flip, InvalidSizesAndPixelDensitiesAreRefused) {
    EXPECT_EQ(flip_error_text(catoptric::Failure::bad_data, 4, 3, 3, 4),
              "FLIP wants two pictures of the same size, found 4x3 and 3x4");
    EXPECT_EQ(flip_error_text(catoptric::Failure::bad_data, 0, 0, 0, 0),
              "FLIP wants at least one pixel, found 0x0");
    EXPECT_EQ(flip_error_text(catoptric::Failure::usage, 4, 3, 4, 3, 0),
              "FLIP wants 1 to 1000 pixels per degree, found 0");
    EXPECT_EQ(flip_error_text(catoptric::Failure::usage, 4, 3, 4, 3,
                              std::numeric_limits<double>::quiet_NaN()),
              "FLIP wants 1 to 1000 pixels per degree, found nan");
}

} // namespace
} // namespace catoptric::measure
