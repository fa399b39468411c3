#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace catoptric::measure {

/// What each of several players is worth in games that they can play together in any company: the
/// mean, over all orders in which they can come, of what the game's value rises when the player
/// comes (Shapley). The players' worths add up to the rise from none of them to all; who never
/// changes a value is worth 0; who changes all alike are worth the same. Worths are sums over games
/// as values are, so games can be added up before or after.
class Shapley {
public:
    /// 1 to 16 players, as many games beside each other as one likes.
    Shapley(std::size_t players, std::size_t games);

    /// Entry g: the value of game g when the players of `coalition` (bit i: player i) have come.
    /// Each of the 2^players coalitions once, in any order; costs a product a player and game.
    /// Throws `internal` for one that came before, or that has a player or a game too many.
    void add(std::uint32_t coalition, std::span<const double> values);
    /// Entry g: what the player is worth in game g. Throws `internal` before all coalitions came.
    const std::vector<double>& worth(std::size_t player) const;

private:
    std::size_t games_;
    std::vector<std::vector<double>> worth_; ///< by player, of the coalitions so far
    std::vector<bool> came_;                 ///< by coalition
};

} // namespace catoptric::measure
