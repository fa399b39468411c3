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

Front front_of(const std::vector<Candidate>& candidates) { return pareto_front(candidates); }

TEST(Pareto, HandComputed) {
    EXPECT_EQ(front_of({{3, 1}, {1, 3}, {2, 2}, {3, 3}, {2, 2.5}}), (Front{1, 2, 0}));
    EXPECT_EQ(front_of({{5, 5}}), Front{0});
    EXPECT_EQ(front_of({}), Front{});
}

TEST(Pareto, Ties) {
    EXPECT_EQ(front_of({{1, 2}, {1, 1}}), Front{1});              // same cost: the better one
    EXPECT_EQ(front_of({{2, 1}, {1, 1}}), Front{1});              // same error: the cheaper one
    EXPECT_EQ(front_of({{1, 1}, {2, 2}, {1, 1}}), (Front{0, 2})); // the same: both, by index
    EXPECT_EQ(front_of({{0.0, 1}, {-0.0, 1}}), (Front{0, 1}));
}

TEST(Pareto, NanIsNeverOnItAndBeatsNobody) {
    EXPECT_EQ(front_of({{kNan, 0}, {0, kNan}, {5, 5}, {kNan, kNan}}), Front{2});
    EXPECT_EQ(front_of({{kNan, 0}}), Front{});
}

TEST(Pareto, InfinityIsJustVeryMuch) {
    EXPECT_EQ(front_of({{kInfinity, 0}, {1, kInfinity}, {kInfinity, 1}}), (Front{1, 0}));
}

TEST(Pareto, EqualsItsDefinition) {
    std::mt19937 random(7);
    std::uniform_int_distribution<int> value(0, 9); // few values: many ties
    for (int round = 0; round < 200; ++round) {
        std::vector<Candidate> all(1 + static_cast<std::size_t>(round) % 30);
        for (Candidate& c : all) {
            c = {static_cast<double>(value(random)), static_cast<double>(value(random))};
            if (value(random) == 0) c.error = kNan;
        }
        Front wanted;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const bool beaten = std::any_of(all.begin(), all.end(), [&](const Candidate& other) {
                return other.cost <= all[i].cost && other.error <= all[i].error &&
                       (other.cost < all[i].cost || other.error < all[i].error);
            });
            if (!beaten && !std::isnan(all[i].error)) wanted.push_back(i);
        }
        Front found = pareto_front(all);
        EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [&](std::size_t a, std::size_t b) {
            return all[a].cost < all[b].cost;
        }));
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, wanted);
    }
}

} // namespace
} // namespace catoptric::measure
