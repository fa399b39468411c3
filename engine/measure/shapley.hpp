#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace catoptric::measure {

/// Computes Shapley values. Several players can play a game together in any coalition. A
/// player's worth is the mean rise of the game's value when the player joins, over all orders in
/// which the players can join. The worths add up to the rise from no player to all. A player who
/// never changes a value is worth 0. Players with the same effect are worth the same. Worths are
/// linear in the values, so games can be added up before or after.
class ShapleyValues {
public:
    /// Prepares 1 to 16 players and any number of games that are evaluated together. Throws
    /// `internal` for another number of players.
    ShapleyValues(std::size_t players, std::size_t games);

    /// Adds the values of a coalition. Bit i of `coalition` stands for player i, and entry g of
    /// `values` is the value of game g. Each of the 2^players coalitions must be added once, in any
    /// order. Costs one product a player and game. Throws `internal` if the coalition was added
    /// before, has a player too many, or comes with a wrong number of games.
    void add(std::uint32_t coalition, std::span<const double> values);
    /// Returns the worth of the player in each game (entry g: game g). Throws `internal` before all
    /// coalitions were added.
    const std::vector<double>& worth(std::size_t player) const;

private:
    std::size_t games_;
    /// Sum for each player and game: the Shapley value once all coalitions were added.
    std::vector<std::vector<double>> worth_;
    std::vector<bool> came_; ///< whether each coalition was added
};

} // namespace catoptric::measure
