#include "measure/statistics.hpp"

#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace catoptric::measure {
namespace {

TEST(Summary, SummaryMatchesHandComputedValues) {
    const SampleSummary s = summarise(std::vector<double>{4, 1, 3, 2, 10});
    EXPECT_DOUBLE_EQ(s.median, 3);
    EXPECT_DOUBLE_EQ(s.p05, 1.2); // the 5th percentile is at rank 0.2 of the sorted samples
    EXPECT_DOUBLE_EQ(s.p95, 8.8); // the 95th percentile is at rank 3.8 of the sorted samples
    EXPECT_DOUBLE_EQ(s.mad, 1);   // median of the deviations 1 2 0 1 7
    EXPECT_EQ(s.n, 5U);
    EXPECT_EQ(s.samples, (std::vector<double>{4, 1, 3, 2, 10})); // samples stay in their order
}

TEST(Summary, SummaryHandlesAnEvenCountAndASingleSample) {
    const SampleSummary even = summarise(std::vector<double>{4, 1, 2, 3});
    EXPECT_DOUBLE_EQ(even.median, 2.5);
    EXPECT_DOUBLE_EQ(even.mad, 1); // median of the deviations 1.5 1.5 0.5 0.5
    const SampleSummary one = summarise(std::vector<double>{7});
    EXPECT_EQ(one.median, 7);
    EXPECT_EQ(one.p05, 7);
    EXPECT_EQ(one.p95, 7);
    EXPECT_EQ(one.mad, 0);
}

TEST(Percentile, PercentileFindsEveryRankOfAShuffledList) {
    std::vector<double> values;
    for (int i = 0; i <= 100; ++i) values.push_back(i);
    std::shuffle(values.begin(), values.end(), std::mt19937(1));
    for (int i = 0; i <= 100; ++i) EXPECT_NEAR(percentile(values, i / 100.0), i, 1e-12);
    EXPECT_NEAR(percentile(values, 0.123), 12.3, 1e-12);
}

TEST(Summary, SummaryIgnoresOrderAndScalesWithTheSamples) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> value(1, 5);
    std::vector<double> samples(21);
    for (double& sample : samples) sample = value(random);
    const SampleSummary s = summarise(samples);
    std::vector<double> doubled = samples;
    for (double& sample : doubled) sample *= 2;
    std::reverse(doubled.begin(), doubled.end());
    const SampleSummary t = summarise(doubled);
    EXPECT_EQ(t.median, 2 * s.median);
    EXPECT_EQ(t.p05, 2 * s.p05);
    EXPECT_EQ(t.p95, 2 * s.p95);
    EXPECT_EQ(t.mad, 2 * s.mad);
}

std::string statistics_error_text(const std::vector<double>& samples) {
    return test::catch_error_text(catoptric::Failure::internal, [&] { summarise(samples); });
}

TEST(Summary, SummaryRefusesEmptyAndNonfiniteSamples) {
    EXPECT_EQ(statistics_error_text({}), "a summary wants at least one sample, found none");
    EXPECT_EQ(statistics_error_text({1, std::numeric_limits<double>::quiet_NaN()}),
              "a summary wants finite samples, found nan at index 1");
    EXPECT_EQ(statistics_error_text({std::numeric_limits<double>::infinity()}),
              "a summary wants finite samples, found inf at index 0");
    EXPECT_THROW(percentile({}, 0.5), Error);
    EXPECT_THROW(percentile({1}, 1.5), Error);
    EXPECT_THROW(percentile({1}, std::numeric_limits<double>::quiet_NaN()), Error);
}

} // namespace
} // namespace catoptric::measure
