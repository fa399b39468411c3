// Tests of the summary of a search's direction errors (measure/lookup.hpp).
#include "measure/lookup.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using catoptric::dvec3;
using catoptric::measure::LookupError;
using catoptric::measure::LookupSummary;
using catoptric::measure::summarise_lookups;

TEST(LookupErrors, AllValuesOfAnEmptyListAreZero) {
    const LookupSummary none = summarise_lookups({});
    EXPECT_EQ(none.pixels, 0U);
    for (const double value : {none.mean_degrees, none.p95_degrees, none.p99_degrees,
                               none.wrong_object, none.unknown, none.miss, none.p95_residual})
        EXPECT_EQ(value, 0);
}

TEST(LookupErrors, SharesAreOfAllPixelsAndResidualsOnlyOfHits) {
    std::vector<LookupError> pixels;
    for (int i = 1; i <= 200; ++i) // angles of 1 to 200 hundredths, largest first
        pixels.push_back({.angle_degrees = .01 * (201 - i),
                          .wrong_object = i <= 10,
                          .state = i <= 100   ? 0
                                   : i <= 160 ? 1
                                              : 2,
                          .residual = i <= 100 ? .001 * i : 1});
    const LookupSummary error = summarise_lookups(pixels);
    EXPECT_EQ(error.pixels, 200U);
    EXPECT_NEAR(error.mean_degrees, 1.005, 1e-12);
    EXPECT_NEAR(error.p95_degrees, 1.9005, 1e-12); // rank .95 * 199 of the sorted angles
    EXPECT_NEAR(error.p99_degrees, 1.9801, 1e-12);
    EXPECT_DOUBLE_EQ(error.wrong_object, .05);
    EXPECT_DOUBLE_EQ(error.unknown, .3);
    EXPECT_DOUBLE_EQ(error.miss, .2);
    EXPECT_NEAR(error.p95_residual, .09505, 1e-12);
}

} // namespace
