// Tests of confidence intervals of medians.
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace catoptric::measure {
namespace {

std::vector<double> list_numbers_from_one_to(std::size_t n) {
    std::vector<double> values(n);
    std::iota(values.begin(), values.end(), 1.0);
    std::ranges::reverse(values); // the order of the values must not matter
    return values;
}

bool does_interval_hold(const Interval& interval, double value) {
    return interval.low <= value && value <= interval.high;
}

/// The expected ranks come from tables of the sign test (Dixon and Mood 1946, two-sided, 5 %).
TEST(MedianInterval, IntervalEndsAtTheRanksOfTheSignTest) {
    const std::pair<std::size_t, double> ranks[] = {
        {6, 1}, {8, 1}, {9, 2}, {11, 2}, {12, 3}, {15, 4}, {20, 6}, {30, 10}, {50, 18}, {100, 40}};
    for (const auto& [n, rank] : ranks) {
        const Interval found = median_interval(list_numbers_from_one_to(n));
        EXPECT_EQ(found.low, rank) << n;
        EXPECT_EQ(found.high, static_cast<double>(n) + 1 - rank) << n;
    }
}

TEST(MedianInterval, IntervalOfFewerThanSixValuesOrNanIsUnknown) {
    for (std::size_t n = 0; n < kMinIntervalSamples; ++n)
        EXPECT_FALSE(median_interval(list_numbers_from_one_to(n)).is_known());
    std::vector<double> values = list_numbers_from_one_to(6);
    values[3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(median_interval(values).is_known());
}

/// The interval contains the true median in at least 95 % of cases, although the samples come from
/// a skewed distribution.
TEST(MedianInterval, IntervalContainsTheTrueMedianIn95PercentOfCases) {
    std::mt19937 random(5);
    std::lognormal_distribution<double> value(0, 2); // the true median is 1
    for (const std::size_t n : {6U, 9U, 30U}) {
        int held = 0;
        for (int k = 0; k < 4000; ++k) {
            std::vector<double> values(n);
            for (double& v : values) v = value(random);
            held += does_interval_hold(median_interval(values), 1);
        }
        EXPECT_GE(held, 3800) << n;
        EXPECT_LT(held, 3960) << n << ": as wide as that it tells nobody apart";
    }
}

TEST(MedianInterval, PairedIntervalUsesTheRatioOrDifferenceOfEachPair) {
    // The rounds have very different lengths, but each round of b is 5 % longer than the same round
    // of a.
    const std::vector<double> a{1, 10, 2, 20, 3, 30}, b{1.05, 10.5, 2.1, 21, 3.15, 31.5};
    const Interval ratio = median_ratio_interval(b, a);
    EXPECT_NEAR(ratio.low, 1.05, 1e-12);
    EXPECT_NEAR(ratio.high, 1.05, 1e-12);
    const Interval difference = median_difference_interval(b, a);
    EXPECT_NEAR(difference.low, .05, 1e-12);
    EXPECT_NEAR(difference.high, 1.5, 1e-12);
    EXPECT_FALSE(median_ratio_interval(a, std::vector<double>(5, 1.0)).is_known()) << "five pairs";
}

TEST(Summary, SummaryOfRoundsUsesTheMedianOfEachRound) {
    const std::vector<std::vector<double>> rounds{{1, 2, 90}, {3}, {5, 4}, {7, 6, 8}, {9}, {10}};
    const SampleSummary summary = summarise(rounds);
    EXPECT_EQ(summary.rounds, (std::vector<double>{2, 3, 4.5, 7, 9, 10}));
    EXPECT_EQ(summary.median, 5.75) << "not that of the eleven samples, 6";
    EXPECT_EQ(summary.ci95.low, 2);
    EXPECT_EQ(summary.ci95.high, 10);
    EXPECT_EQ(summary.n, 11U);
    EXPECT_EQ(summary.samples, (std::vector<double>{1, 2, 90, 3, 5, 4, 7, 6, 8, 9, 10}));
    EXPECT_FALSE(summarise(std::vector<double>{1, 2, 3, 4, 5, 6}).ci95.is_known())
        << "in one go: what disturbed one disturbed its neighbours";
}

MedianWithInterval measure_median(std::vector<double> values) {
    const double middle = summarise(values).median;
    return {middle, median_interval(values)};
}

/// The interval of a ratio is exact for two equal intervals of 2 %, and unknown without intervals.
TEST(RatioOfMedians, DistancesAreRootsOfSumsOfSquares) {
    const MedianWithInterval a{20, {20 / 1.02, 20 * 1.02}}, b{10, {10 / 1.02, 10 * 1.02}};
    const MedianWithInterval ratio = ratio_of_medians(a, b);
    const double factor = std::exp(std::sqrt(2.0) * std::log(1.02));
    EXPECT_NEAR(ratio.median, 2, 1e-12);
    EXPECT_NEAR(ratio.ci95.low, 2 / factor, 1e-12);
    EXPECT_NEAR(ratio.ci95.high, 2 * factor, 1e-12);
    // The lower end follows from the low end of `a` and the high end of `b`.
    const MedianWithInterval skewed = ratio_of_medians({20, {20, 25}}, {10, {8, 10}});
    EXPECT_NEAR(skewed.ci95.low, 2, 1e-12);
    EXPECT_NEAR(skewed.ci95.high, 2 * std::exp(std::hypot(std::log(1.25), std::log(1.25))), 1e-12);
    EXPECT_FALSE(ratio_of_medians(a, {10, {}}).ci95.is_known());
    EXPECT_FALSE(ratio_of_medians({20, {}}, b).ci95.is_known());
    EXPECT_FALSE(ratio_of_medians(a, {10, {0, 11}}).ci95.is_known());
}

TEST(RatioOfMedians, IntervalContainsTheTrueRatioIn95PercentOfCases) {
    std::mt19937 random(7);
    for (const double spread : {.02, .3}) {
        std::lognormal_distribution<double> now(std::log(1.15), spread), before(0, 3 * spread);
        for (const std::size_t n : {6U, 9U, 20U}) {
            int held = 0;
            for (int k = 0; k < 4000; ++k) {
                std::vector<double> a(n), b(n);
                for (double& v : a) v = now(random);
                for (double& v : b) v = before(random);
                held += does_interval_hold(
                    ratio_of_medians(measure_median(a), measure_median(b)).ci95, 1.15);
            }
            EXPECT_GE(held, 3770) << n << ' ' << spread; // 3800 minus two standard deviations
            EXPECT_LT(held, 3960) << n << ' ' << spread
                                  << ": as wide as that it tells nobody apart";
        }
    }
}

} // namespace
} // namespace catoptric::measure
