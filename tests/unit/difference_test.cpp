#include "measure/picture.hpp"

#include "support/refusal.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace catoptric::measure {
namespace {

using testing::HasSubstr;

Picture make_picture_of_one_row(const std::vector<vec3>& pixels) {
    Picture picture(static_cast<int>(pixels.size()), 1);
    picture.pixels = pixels;
    return picture;
}

Picture make_random_uniform_picture(int width, int height, unsigned seed, float low, float high) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(low, high);
    Picture picture(width, height);
    for (vec3& pixel : picture.pixels) pixel = vec3(value(random), value(random), value(random));
    return picture;
}

TEST(Difference, FiguresEqualHandComputedValues) {
    const Picture a = make_picture_of_one_row({vec3(0), vec3(0.5F, 0.25F, 1), vec3(1)});
    const Picture b = make_picture_of_one_row({vec3(0), vec3(0.25F, 0.75F, 1), vec3(0.5F, 1, 1)});
    const Difference d = difference(a, b, {}, std::vector<float>{0, 0.25F, 0.5F});
    EXPECT_EQ(d.pixels, 3U);
    EXPECT_EQ(d.nonfinite, 0U);
    EXPECT_DOUBLE_EQ(d.rmse, 0.25); // rmse squared: (1/16 + 1/4 + 1/4) / 9 = 1/16
    EXPECT_DOUBLE_EQ(d.mae, 1.25 / 9);
    EXPECT_DOUBLE_EQ(d.flip, 0.25);
    EXPECT_DOUBLE_EQ(d.psnr.value(), 12.041199826559248); // PSNR of an rmse of 1/4: 20 log10 4
    EXPECT_DOUBLE_EQ(d.max, 0.5);
    EXPECT_EQ(d.max_x, 1); // the first of two pixels with the largest difference
    EXPECT_EQ(d.max_y, 0);
    EXPECT_DOUBLE_EQ(d.p99, 0.5);
}

TEST(Difference, P99InterpolatesLinearlyBetweenRanks) {
    std::vector<vec3> ramp;
    for (int i = 0; i <= 50; ++i) ramp.push_back(vec3(0, static_cast<float>(i) / 64.0F, 0));
    const Difference d = difference(make_picture_of_one_row(ramp), Picture(51, 1), {},
                                    std::vector<float>(51));
    EXPECT_DOUBLE_EQ(d.p99, 49.5 / 64); // rank 0.99 * 50 = 49.5, between two samples
    EXPECT_DOUBLE_EQ(d.max, 50.0 / 64);
    EXPECT_EQ(d.max_x, 50);
}

TEST(Difference, ValuesAreClampedToTheDisplayRange) {
    const Picture a = make_picture_of_one_row({vec3(17, -4, 0.5F)});
    const Picture b = make_picture_of_one_row({vec3(1, 0, 0.5F)});
    const Difference d = difference(a, b, {}, std::vector<float>{0});
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.max, 0);
    EXPECT_FALSE(d.psnr.has_value());
    EXPECT_EQ(d.max_x, 0);
}

TEST(Difference, OnlyPixelsOfTheMaskCount) {
    const Picture a = make_picture_of_one_row({vec3(1), vec3(1), vec3(0)});
    const Difference d = difference(a, Picture(3, 1), {0, 1, 255},
                                    std::vector<float>{1, 0.5F, 0.25F});
    EXPECT_EQ(d.pixels, 2U);
    EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(0.5));
    EXPECT_DOUBLE_EQ(d.mae, 0.5);
    EXPECT_DOUBLE_EQ(d.flip, 0.375);
    EXPECT_EQ(d.max_x, 1);
}

TEST(Difference, NonFinitePixelsOfEitherPictureAreCountedAndLeftOut) {
    const Picture a = make_picture_of_one_row(
        {vec3(0, test::kFloatNan, 0), vec3(0.5F), vec3(1), vec3(test::kFloatInfinity)});
    const Picture b = make_picture_of_one_row(
        {vec3(0), vec3(0), vec3(1, 1, -test::kFloatInfinity), vec3(test::kFloatNan)});
    const Difference d = difference(a, b, {}, std::vector<float>{1, 0.5F, 1, 1});
    EXPECT_EQ(d.pixels, 4U);
    EXPECT_EQ(d.nonfinite, 3U);
    EXPECT_DOUBLE_EQ(d.rmse, 0.5);
    EXPECT_DOUBLE_EQ(d.flip, 0.5);
    EXPECT_DOUBLE_EQ(d.p99, 0.5);
    EXPECT_EQ(d.max_x, 1);
    const Difference masked = difference(a, b, {0, 1, 0, 0}, std::vector<float>(4));
    EXPECT_EQ(masked.nonfinite, 0U);
}

TEST(Difference, DifferenceWithoutFinitePixelsIsNan) {
    const Picture a = make_picture_of_one_row({vec3(test::kFloatNan)});
    for (const Mask& mask : {Mask{0}, Mask{1}}) {
        const Difference d = difference(a, a, mask, std::vector<float>{0});
        EXPECT_EQ(d.pixels, mask[0]);
        EXPECT_EQ(d.nonfinite, mask[0]);
        for (const double figure : {d.rmse, d.mae, d.flip, d.p99, d.max, d.off, d.longest_line})
            EXPECT_TRUE(std::isnan(figure));
        EXPECT_FALSE(d.psnr.has_value());
        EXPECT_EQ(d.max_x, -1);
        EXPECT_EQ(d.max_y, -1);
    }
}

TEST(Difference, DifferenceIsSymmetricAndIndependentOfPixelOrder) {
    const int width = 37;
    const Picture a = make_random_uniform_picture(width, 23, 1, 0, 1);
    const Picture b = make_random_uniform_picture(width, 23, 2, 0, 1);
    std::vector<float> map(a.pixels.size());
    for (std::size_t i = 0; i < map.size(); ++i) map[i] = static_cast<float>(i % 7) / 8.0F;
    const Difference d = difference(a, b, {}, map);
    const Difference swapped = difference(b, a, {}, map);
    EXPECT_EQ(d.rmse, swapped.rmse);
    EXPECT_EQ(d.mae, swapped.mae);
    EXPECT_EQ(d.p99, swapped.p99);
    EXPECT_EQ(d.max_y * width + d.max_x, swapped.max_y * width + swapped.max_x);

    std::vector<std::size_t> order(map.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    Picture c = a, e = b;
    std::vector<float> shuffled_map = map;
    for (std::size_t i = 0; i < order.size(); ++i) {
        c.pixels[i] = a.pixels[order[i]];
        e.pixels[i] = b.pixels[order[i]];
        shuffled_map[i] = map[order[i]];
    }
    const Difference shuffled = difference(c, e, {}, shuffled_map);
    EXPECT_NEAR(d.rmse, shuffled.rmse, 1e-13);
    EXPECT_NEAR(d.mae, shuffled.mae, 1e-13);
    EXPECT_NEAR(d.flip, shuffled.flip, 1e-13);
    EXPECT_EQ(d.p99, shuffled.p99);
    EXPECT_EQ(d.max, shuffled.max);
    EXPECT_EQ(order[static_cast<std::size_t>(shuffled.max_y * width + shuffled.max_x)],
              static_cast<std::size_t>(d.max_y * width + d.max_x));
}

TEST(Difference, FiguresAgreeWithAnIndependentComputation) {
    const Picture a = make_random_uniform_picture(16, 16, 4, -0.2F, 1.3F);
    const Picture b = make_random_uniform_picture(16, 16, 5, -0.2F, 1.3F);
    // Computes the expected figures independently of the tested code: one channel at a time, with a
    // full sort.
    long double squares = 0, absolutes = 0;
    std::vector<double> largest(256, 0);
    for (int c = 2; c >= 0; --c)
        for (std::size_t i = 256; i-- > 0;) {
            const double va = std::min(1.0, std::max(0.0, double{a.pixels[i][c]}));
            const double vb = std::min(1.0, std::max(0.0, double{b.pixels[i][c]}));
            squares += static_cast<long double>((va - vb) * (va - vb));
            absolutes += static_cast<long double>(std::abs(va - vb));
            largest[i] = std::max(largest[i], std::abs(va - vb));
        }
    std::sort(largest.begin(), largest.end());
    const Difference d = difference(a, b, {}, std::vector<float>(256));
    EXPECT_NEAR(d.rmse, std::sqrt(static_cast<double>(squares) / 768), 1e-14);
    EXPECT_NEAR(d.mae, static_cast<double>(absolutes) / 768, 1e-14);
    EXPECT_NEAR(d.p99, largest[252] + 0.45 * (largest[253] - largest[252]), 1e-14);
    EXPECT_EQ(d.max, largest.back());
    EXPECT_NEAR(d.psnr.value(), -10 * std::log10(static_cast<double>(squares) / 768), 1e-11);
}

TEST(Difference, PicturesMasksAndMapsOfDifferentSizesAreRefused) {
    const std::vector<float> map(6);
    EXPECT_EQ(test::catch_error_text(Failure::bad_data,
                                     [&] { difference(Picture(3, 2), Picture(2, 3), {}, map); }),
              "a difference wants two pictures of the same size, found 3x2 and 2x3");
    EXPECT_EQ(
        test::catch_error_text(Failure::bad_data,
                               [&] { difference(Picture(3, 2), Picture(3, 2), Mask(5), map); }),
        "a difference of 6 pixels wants a mask of as many, found 5");
    EXPECT_EQ(test::catch_error_text(
                  Failure::bad_data,
                  [&] { difference(Picture(3, 2), Picture(3, 2), {}, std::vector<float>(7)); }),
              "a difference of 6 pixels wants a FLIP map of as many, found 7");
    EXPECT_THAT(
        test::catch_error_text(Failure::bad_data,
                               [&] { mean_of(Picture(3, 2), ValueRange::clamped, Mask(5)); }),
        HasSubstr("a mean of 6 pixels wants a mask of as many, found 5"));
}

TEST(Mean, MeanUsesUnclampedOrClampedValues) {
    const Picture picture = make_picture_of_one_row({vec3(0, 3, -1), vec3(1, 0.5F, 0.5F)});
    const Mean plain = mean_of(picture, ValueRange::unclamped);
    EXPECT_EQ(plain.rgb, dvec3(0.5, 1.75, -0.25));
    EXPECT_DOUBLE_EQ(plain.all, 2.0 / 3);
    const Mean clamped = mean_of(picture, ValueRange::clamped);
    EXPECT_EQ(clamped.rgb, dvec3(0.5, 0.75, 0.25));
    EXPECT_DOUBLE_EQ(clamped.all, 0.5);
    EXPECT_EQ(mean_of(picture, ValueRange::unclamped, {0, 1}).rgb, dvec3(1, 0.5, 0.5));
    EXPECT_TRUE(std::isnan(mean_of(picture, ValueRange::clamped, {0, 0}).all));
}

TEST(Mean, MeanOfNanIsNan) {
    const Picture picture = make_picture_of_one_row(
        {vec3(test::kFloatNan, test::kFloatInfinity, 0.5F)});
    for (const ValueRange range : {ValueRange::unclamped, ValueRange::clamped})
        EXPECT_TRUE(std::isnan(mean_of(picture, range).rgb.x));
    EXPECT_EQ(mean_of(picture, ValueRange::clamped).rgb.y, 1);
    EXPECT_TRUE(std::isinf(mean_of(picture, ValueRange::unclamped).rgb.y));
}

} // namespace
} // namespace catoptric::measure
