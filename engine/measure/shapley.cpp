#include "measure/shapley.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <bit>

namespace catoptric::measure {

namespace {

/// Returns the share of orders in which a player joins after exactly `before` given other players:
/// k! (n-1-k)! / n!.
double shapley_weight(std::size_t before, std::size_t players) {
    double share = 1 / static_cast<double>(players);
    for (std::size_t k = 1; k <= before; ++k)
        share *= static_cast<double>(k) / static_cast<double>(players - k);
    return share;
}

} // namespace

ShapleyValues::ShapleyValues(std::size_t players, std::size_t games) : games_(games) {
    check(players >= 1 && players <= 16, Failure::internal, "wanted 1 to 16 players, found ",
          players);
    worth_.assign(players, std::vector<double>(games));
    came_.resize(std::size_t{1} << players);
}

void ShapleyValues::add(std::uint32_t coalition, std::span<const double> values) {
    check(coalition < came_.size(), Failure::internal, "coalition ", coalition, " of ",
          worth_.size(), " players: wanted a number below ", came_.size());
    check(!came_[coalition], Failure::internal, "coalition ", coalition, " came twice");
    check(values.size() == games_, Failure::internal, "coalition ", coalition,
          ": wanted values of ", games_, " games, found ", values.size());
    came_[coalition] = true;
    const auto size = static_cast<std::size_t>(std::popcount(coalition));
    for (std::size_t player = 0; player < worth_.size(); ++player) {
        // The difference is added for a coalition that contains the player, and subtracted for a
        // coalition without the player.
        const bool is_in = (coalition >> player & 1U) != 0;
        const double weight = is_in ? shapley_weight(size - 1, worth_.size())
                                    : -shapley_weight(size, worth_.size());
        std::vector<double>& worth = worth_[player];
        for (std::size_t game = 0; game < games_; ++game) worth[game] += weight * values[game];
    }
}

const std::vector<double>& ShapleyValues::worth(std::size_t player) const {
    const auto missing = std::ranges::find(came_, false);
    check(missing == came_.end(), Failure::internal, "coalition ", missing - came_.begin(), " of ",
          worth_.size(), " players is missing");
    return worth_.at(player);
}

} // namespace catoptric::measure
