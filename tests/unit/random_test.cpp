// Tests of random numbers that are computed from counters (shaders/lib/math/random.glsl):
// stratification, independence and repeatability.
#include "core/shader_math.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace {

using namespace catoptric;

struct UnitSquarePoint {
    float u, v;
};

UnitSquarePoint make_pattern_point(std::uint32_t pixel, std::uint32_t index, std::uint32_t pair,
                                   std::uint32_t seed) {
    UnitSquarePoint point{};
    f32::sample_pattern_point(pixel, index, pair, seed, point.u, point.v);
    return point;
}

TEST(Random, ReversesBits) {
    EXPECT_EQ(f32::reverse_bits_of_word(1), 0x80000000u);
    EXPECT_EQ(f32::reverse_bits_of_word(0x12345678u), 0x1e6a2c48u);
    EXPECT_EQ(f32::reverse_bits_of_word(f32::reverse_bits_of_word(0xdeadbeefu)), 0xdeadbeefu);
}

TEST(Random, SecondCoordinateIsThatOfSobolsSequence) {
    // The first points of the second dimension of the Sobol sequence, not in Gray-code order: 0,
    // 1/2, 3/4, 1/4, 5/8, 1/8, 3/8, 7/8.
    const double wanted[] = {0, .5, .75, .25, .625, .125, .375, .875};
    for (std::uint32_t i = 0; i < 8; ++i)
        EXPECT_EQ(f32::sobol_second_dimension(i) * 0x1p-32, wanted[i]) << i;
}

/// Of the first 2^k points, exactly one must lie in each elementary interval of area 2^-k, whatever
/// the interval's shape. Independent random points fail this test, and so does a scrambling that
/// mixes strata.
TEST(Random, FirstPointsAreANet) {
    for (const std::uint32_t pixel : {0u, 17u, 262143u})
        for (const std::uint32_t seed : {1u, 99u})
            for (std::uint32_t k = 1; k <= 8; ++k)
                for (std::uint32_t across = 0; across <= k; ++across) {
                    std::set<std::pair<int, int>> cells;
                    for (std::uint32_t i = 0; i < 1u << k; ++i) {
                        const UnitSquarePoint point = make_pattern_point(pixel, i, 3, seed);
                        cells.emplace(int(point.u * float(1u << across)),
                                      int(point.v * float(1u << (k - across))));
                    }
                    EXPECT_EQ(cells.size(), std::size_t{1} << k)
                        << pixel << " " << seed << " " << k << " " << across;
                }
}

TEST(Random, NumbersLieInTheUnitSquareAndAreEqualForEqualArguments) {
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const UnitSquarePoint a = make_pattern_point(i, i / 3, i % 7, 5),
                              b = make_pattern_point(i, i / 3, i % 7, 5);
        EXPECT_TRUE(a.u >= 0 && a.u < 1 && a.v >= 0 && a.v < 1);
        EXPECT_TRUE(a.u == b.u && a.v == b.v);
    }
}

double correlation_of_samples(const std::vector<double>& a, const std::vector<double>& b) {
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - .5) * (b[i] - .5);
        aa += (a[i] - .5) * (a[i] - .5), bb += (b[i] - .5) * (b[i] - .5);
    }
    return ab / std::sqrt(aa * bb);
}

/// Different pixels, dimensions and seeds must have independent patterns.
TEST(Random, PixelsDimensionsAndSeedsAreIndependent) {
    constexpr std::uint32_t kPatternPointCount = 4096;
    const auto sample_series = [&](auto&& point_at) {
        std::vector<double> values;
        for (std::uint32_t i = 0; i < kPatternPointCount; ++i) values.push_back(point_at(i).u);
        return values;
    };
    const auto base = sample_series([](std::uint32_t i) { return make_pattern_point(i, 0, 0, 1); });
    const double most = 4 / std::sqrt(double(kPatternPointCount)); // four standard errors
    EXPECT_LT(std::abs(correlation_of_samples(base, sample_series([](std::uint32_t i) {
                                                  return make_pattern_point(i + 1, 0, 0, 1);
                                              }))),
              most);
    EXPECT_LT(std::abs(correlation_of_samples(base, sample_series([](std::uint32_t i) {
                                                  return make_pattern_point(i, 1, 0, 1);
                                              }))),
              1); // samples of one pixel are stratified and therefore not independent
    EXPECT_LT(std::abs(correlation_of_samples(base, sample_series([](std::uint32_t i) {
                                                  return make_pattern_point(i, 0, 1, 1);
                                              }))),
              most);
    EXPECT_LT(std::abs(correlation_of_samples(base, sample_series([](std::uint32_t i) {
                                                  return make_pattern_point(i, 0, 0, 2);
                                              }))),
              most);
    double sum = 0;
    for (const double value : base) sum += value;
    EXPECT_NEAR(sum / kPatternPointCount, .5, 4 * .2887 / std::sqrt(double(kPatternPointCount)));
}

/// The error of a mean over n stratified points must fall faster than 1/sqrt(n), the rate of
/// independent points.
TEST(Random, MeanOfASmoothFunctionConvergesFast) {
    const auto error = [](std::uint32_t count) {
        double squares = 0;
        for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
            double sum = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                const UnitSquarePoint point = make_pattern_point(pixel, i, 0, 7);
                sum += std::exp(point.u) * point.v;
            }
            const double wanted = (std::exp(1.0) - 1) / 2;
            squares += std::pow(sum / count - wanted, 2);
        }
        return std::sqrt(squares / 64);
    };
    EXPECT_LT(error(256), error(16) / 8); // independent points would reduce the error by a factor
                                          // of 4
}

} // namespace
