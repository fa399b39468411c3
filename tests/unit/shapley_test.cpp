// Tests of Shapley values in games whose values are known.
#include "measure/shapley.hpp"

#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace {

using catoptric::Failure;
using catoptric::measure::ShapleyValues;

constexpr std::size_t kPlayerCount = 5;
constexpr std::uint32_t kAllPlayersCoalition = 31;

/// Returns the worth of each player in a game in which coalition c has the value `value(c)`.
std::vector<double> list_worths_of_players(const std::function<double(std::uint32_t)>& value) {
    ShapleyValues shapley(kPlayerCount, 1);
    for (std::uint32_t c = kAllPlayersCoalition + 1; c-- > 0;)
        shapley.add(c, std::vector{value(c)});
    std::vector<double> worths;
    for (std::size_t i = 0; i < kPlayerCount; ++i) worths.push_back(shapley.worth(i)[0]);
    return worths;
}

/// An amount that a coalition's value gains if the coalition holds all `members`.
struct CoalitionBonus {
    std::uint32_t members;
    double amount;
};

// The game of this test is a sum of bonuses. The members of a coalition share each bonus equally.
// There are bonuses for single players, pairs, a triple (a loss) and all five players. Player 3
// takes part in the last bonus only.
const std::vector<CoalitionBonus> kCoalitionBonuses = {
    {0b00000, 7},  {0b00001, 1}, {0b00010, 2},   {0b00011, 4},  {0b10110, -6},
    {0b10001, .5}, {0b00100, 3}, {0b11111, 2.5}, {0b00111, .75}};

double value_of_coalition_with_bonuses(std::uint32_t coalition) {
    double value = 0;
    for (const CoalitionBonus& bonus : kCoalitionBonuses)
        if ((coalition & bonus.members) == bonus.members) value += bonus.amount;
    return value;
}

TEST(Shapley, ShapleySharesEachBonusEquallyAmongItsMembers) {
    const std::vector<double> found = list_worths_of_players(value_of_coalition_with_bonuses);
    for (std::size_t i = 0; i < kPlayerCount; ++i) {
        double wanted = 0;
        for (const CoalitionBonus& bonus : kCoalitionBonuses)
            if ((bonus.members >> i & 1U) != 0)
                wanted += bonus.amount / std::popcount(bonus.members);
        EXPECT_NEAR(found[i], wanted, 1e-14) << "player " << i;
    }
    // Worth of player 0 by hand: 1 + 4/2 + .5/2 + 2.5/5 + .75/3 = 4.
    EXPECT_NEAR(found[0], 4, 1e-14);
    EXPECT_NEAR(found[3], .5, 1e-14);
    EXPECT_NEAR(std::accumulate(found.begin(), found.end(), 0.0),
                value_of_coalition_with_bonuses(kAllPlayersCoalition) -
                    value_of_coalition_with_bonuses(0),
                1e-14)
        << "efficient";
}

TEST(Shapley, PlayerWithoutEffectIsWorthNothing) {
    const auto without_two = [](std::uint32_t c) {
        return std::sqrt(value_of_coalition_with_bonuses(c & ~4U) + 20);
    };
    EXPECT_NEAR(list_worths_of_players(without_two)[2], 0, 1e-14);
}

TEST(Shapley, PlayersWithEqualEffectAreWorthTheSame) {
    const std::vector<double> found = list_worths_of_players(
        [](std::uint32_t c) { return std::exp(.3 * std::popcount(c & 0b01011)) * ((c & 4U) + 1); });
    EXPECT_NEAR(found[0], found[1], 1e-13);
    EXPECT_NEAR(found[0], found[3], 1e-13);
    EXPECT_GT(found[2], found[0]);
    EXPECT_NEAR(found[4], 0, 1e-13);
}

// The glove market is a known game: two players have a left glove, one has a right glove, and a
// pair is worth 1. The players are worth 1/6, 1/6 and 2/3.
TEST(Shapley, ShapleyValuesOfTheGloveMarketAreTheKnownOnes) {
    ShapleyValues market(3, 1);
    for (std::uint32_t c = 0; c < 8; ++c)
        market.add(c, std::vector{(c & 4U) != 0 && (c & 3U) != 0 ? 1.0 : 0.0});
    EXPECT_NEAR(market.worth(0)[0], 1.0 / 6, 1e-15);
    EXPECT_NEAR(market.worth(1)[0], 1.0 / 6, 1e-15);
    EXPECT_NEAR(market.worth(2)[0], 2.0 / 3, 1e-15);
}

TEST(Shapley, ShapleyKeepsSeveralGamesApart) {
    ShapleyValues games(2, 2);
    games.add(0b11, std::vector{5.0, 1.0});
    games.add(0b00, std::vector{0.0, 1.0});
    games.add(0b10, std::vector{1.0, 1.0});
    games.add(0b01, std::vector{2.0, 3.0});
    EXPECT_EQ(games.worth(0), (std::vector{3.0, 1.0}));
    EXPECT_EQ(games.worth(1), (std::vector{2.0, -1.0}));
}

TEST(Shapley, InvalidCoalitionsAndPlayerCountsAreRefused) {
    ShapleyValues shapley(2, 1);
    const std::vector<double> value{1};
    shapley.add(0, value), shapley.add(1, value), shapley.add(3, value);
    for (const auto& [action, words] : std::vector<std::pair<std::function<void()>, std::string>>{
             {[&] { shapley.worth(0); }, "coalition 2 of 2 players is missing"},
             {[&] { shapley.add(3, value); }, "coalition 3 came twice"},
             {[&] { shapley.add(4, value); }, "coalition 4 of 2 players: wanted a number below 4"},
             {[&] { shapley.add(2, {}); }, "coalition 2: wanted values of 1 games, found 0"},
             {[] { ShapleyValues(17, 1); }, "wanted 1 to 16 players, found 17"}})
        test::expect_error(action, Failure::internal, {words});
}

} // namespace
