// Tests of statements about all views that are derived from drawn views: known values, and how
// often the statements are true.
#include "measure/certificate.hpp"
#include "study/choose.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace catoptric::measure;

TEST(Certificate, NumbersOfViewsAreThoseOfTheTables) {
    const struct {
        double share;
        std::size_t failures, views;
    } known[] = {{.90, 0, 29}, {.95, 0, 59}, {.99, 0, 299},
                 {.90, 1, 46}, {.95, 1, 93}, {.99, 1, 473}};
    for (const auto& [share, failures, views] : known)
        EXPECT_EQ(needed_views(share, .95, failures), views) << share << " " << failures;
}

TEST(Certificate, BoundIsTheShareAtWhichTheFailuresBecomeUnlikely) {
    // If no view fails, the lower bound of the passing share is the n-th root of 1 - confidence.
    for (const std::size_t views : {1, 6, 59, 1000})
        EXPECT_NEAR(passing_share_bound(0, views, .95),
                    std::pow(.05, 1.0 / static_cast<double>(views)), 1e-12);
    // For two views with one failure, the bound p solves P(at most one failure) = 1 - p^2 = .05.
    EXPECT_NEAR(passing_share_bound(1, 2, .95), 1 - std::sqrt(.95), 1e-12);
    // For 2 failures in 30 views, the one-sided 95 % Clopper-Pearson bound of the failing share is
    // .19529.
    EXPECT_NEAR(passing_share_bound(2, 30, .95), 1 - .19529, 2e-4);
    EXPECT_EQ(passing_share_bound(0, 0, .95), 0);
    EXPECT_EQ(passing_share_bound(5, 5, .95), 0);
    // A larger number of failures never proves a larger share, and more views without failure never
    // prove a smaller share.
    for (std::size_t failures = 0; failures < 20; ++failures) {
        EXPECT_GT(passing_share_bound(failures, 50, .9), passing_share_bound(failures + 1, 50, .9));
        EXPECT_LT(passing_share_bound(failures, 50, .9), passing_share_bound(failures, 51, .9));
    }
    const double many = passing_share_bound(500, 10'000,
                                            .95); // computed with logarithms, without
                                                  // overflow
    EXPECT_GT(many, .945);
    EXPECT_LT(many, .95);
}

/// The bound may lie above the true share in at most 5 % of all samples.
TEST(Certificate, BoundCoversTheTrueShare) {
    std::mt19937_64 random(5);
    for (const double share : {.8, .9, .95, .99}) {
        std::bernoulli_distribution keeps(share);
        constexpr int kTrials = 4000;
        int wrong = 0;
        for (int trial = 0; trial < kTrials; ++trial) {
            std::size_t failures = 0;
            for (int view = 0; view < 59; ++view) failures += keeps(random) ? 0 : 1;
            wrong += passing_share_bound(failures, 59, .95) > share ? 1 : 0;
        }
        EXPECT_LE(wrong, .05 * kTrials + 3 * std::sqrt(kTrials * .05 * .95)) << share;
    }
}

TEST(Certificate, ToleranceLimitIsTheSmallestValueThatIsLargeEnough) {
    std::vector<double> values(59);
    for (std::size_t i = 0; i < 59; ++i) values[i] = static_cast<double>((i * 37) % 59);
    EXPECT_EQ(upper_tolerance_limit(values, .95, .95), 58); // with 59 views, the limit is the
                                                            // largest value
    values.pop_back();
    EXPECT_TRUE(std::isnan(upper_tolerance_limit(values, .95, .95))); // 58 views are too few
    std::vector<double> more(93);
    for (std::size_t i = 0; i < 93; ++i) more[i] = static_cast<double>(i);
    EXPECT_EQ(upper_tolerance_limit(more, .95, .95), 91); // with 93 views, one view may have a
                                                          // larger error
    EXPECT_TRUE(std::isnan(upper_tolerance_limit({}, .5, .5)));
}

/// For values of any distribution, the limit lies below the true quantile in at most 5 % of all
/// samples. For uniform values the quantile is the share itself.
TEST(Certificate, ToleranceLimitCoversTheQuantile) {
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> uniform(0, 1);
    constexpr int kTrials = 3000;
    for (const std::size_t count : {59, 130}) {
        int wrong = 0;
        for (int trial = 0; trial < kTrials; ++trial) {
            std::vector<double> values(count);
            for (double& value : values) value = uniform(random);
            wrong += upper_tolerance_limit(values, .95, .95) < .95 ? 1 : 0;
        }
        EXPECT_LE(wrong, .05 * kTrials + 3 * std::sqrt(kTrials * .05 * .95)) << count;
    }
}

/// If half of a mirror's pixels are NaN, a view must not be judged by the other half alone.
TEST(Certificate, ViewFailsIfAPixelIsNotFiniteAndKeepsIfItShowsNoMirror) {
    using catoptric::study::ErrorQuantity;
    using catoptric::study::mirror_error;
    Difference view;
    view.pixels = 100, view.flip = .01, view.rmse = .02;
    EXPECT_EQ(mirror_error(ErrorQuantity::flip, view), .01);
    EXPECT_EQ(mirror_error(ErrorQuantity::rmse, view), .02);
    view.nonfinite = 1;
    EXPECT_TRUE(std::isinf(mirror_error(ErrorQuantity::flip, view)));
    view = Difference();
    EXPECT_EQ(mirror_error(ErrorQuantity::flip, view), 0);
}

} // namespace
