#include "measure/pareto.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace catoptric::measure {
namespace {

using Front = std::vector<std::size_t>;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A cost known exactly.
Candidate exact(double cost, double error) { return {cost, cost, cost, error}; }
/// Known to a tenth.
Candidate about(double cost, double error) { return {cost, .9 * cost, 1.1 * cost, error}; }

Front front_of(const std::vector<Candidate>& candidates) { return pareto_front(candidates); }

TEST(Pareto, HandComputed) {
    EXPECT_EQ(front_of({exact(3, 1), exact(1, 3), exact(2, 2), exact(3, 3), exact(2, 2.5)}),
              (Front{1, 2, 0}));
    EXPECT_EQ(front_of({exact(5, 5)}), Front{0});
    EXPECT_EQ(front_of({}), Front{});
}

TEST(Pareto, CostsWithinOneBandAreATie) {
    EXPECT_TRUE(beats(about(10, 1), about(13, 1))) << "cheaper, bands apart";
    EXPECT_FALSE(beats(about(10, 1), about(12, 1))) << "11 is in both bands";
    EXPECT_FALSE(beats(about(12, 1), about(10, 1)));
    EXPECT_TRUE(beats(about(12, .9), about(10, 1))) << "closer, and not told apart in cost";
    EXPECT_FALSE(beats(about(13, .9), about(10, 1))) << "closer, but dearer";
    EXPECT_TRUE(beats(about(10, .9), about(13, 1)));
    EXPECT_FALSE(beats(about(10, 1.1), about(13, 1)));
    EXPECT_FALSE(beats(about(10, 1), about(10, 1)));
    // Bands that touch are not apart.
    EXPECT_FALSE(beats({10, 9, 11, 1}, {12, 11, 13, 1}));

    EXPECT_EQ(front_of({about(12, 1), about(10, 1), about(11, 1)}), (Front{1, 2, 0}));
    EXPECT_EQ(front_of({about(10, 1), about(12, .9), about(13, .9)}), (Front{1, 2}));
}

TEST(Pareto, Ties) {
    EXPECT_EQ(front_of({exact(1, 2), exact(1, 1)}), Front{1}); // same cost: the better one
    EXPECT_EQ(front_of({exact(2, 1), exact(1, 1)}), Front{1}); // same error: the cheaper one
    EXPECT_EQ(front_of({exact(1, 1), exact(2, 2), exact(1, 1)}), (Front{0, 2})); // the same: both
    EXPECT_EQ(front_of({exact(0.0, 1), exact(-0.0, 1)}), (Front{0, 1}));
}

TEST(Pareto, NanIsNeverOnItAndBeatsNobody) {
    EXPECT_EQ(front_of({exact(kNan, 0), exact(0, kNan), exact(5, 5), exact(kNan, kNan)}), Front{2});
    EXPECT_EQ(front_of({exact(kNan, 0)}), Front{});
    EXPECT_FALSE(beats(exact(1, 1), exact(2, kNan)));
}

TEST(Pareto, InfinityIsJustVeryMuch) {
    EXPECT_EQ(front_of({exact(kInfinity, 0), exact(1, kInfinity), exact(kInfinity, 1)}),
              (Front{1, 0}));
}

TEST(Pareto, IsInOrderOfCost) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> value(1, 9); // few values: many ties
    for (int round = 0; round < 200; ++round) {
        std::vector<Candidate> all(1 + static_cast<std::size_t>(round) % 30);
        for (Candidate& c : all) c = about(value(random), value(random));
        const Front found = pareto_front(all);
        ASSERT_FALSE(found.empty()) << "the least error is beaten by cheaper ones of it only";
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
            return std::pair(all[a].cost, a) < std::pair(all[b].cost, b);
        }));
    }
}

} // namespace
} // namespace catoptric::measure
