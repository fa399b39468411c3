#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric::measure {

/// Least squares with values that are not negative: minimises the sum of (row * x - target)^2 over
/// x >= 0. Equations are added and removed one by one, so that a fit without one of them costs no
/// more than another solution.
class LeastSquares {
public:
    explicit LeastSquares(std::size_t unknowns);
    /// Adds an equation `sign` times; -1 removes it again. `row` has a factor for each unknown.
    void add(std::span<const double> row, double target = 1, double sign = 1);
    /// Returns x, by coordinate descent (Franc, Hlavac, Navara, Sequential Coordinate-Wise
    /// Algorithm for the Non-negative Least Squares Problem, 2005). An unknown that no equation has
    /// is 0.
    std::vector<double> solve() const;

    /// Returns row * x for the solution without an equation of this row and the target 1.
    double predict_without(std::span<const double> row) const;

private:
    std::vector<std::vector<double>> matrix_; // x' matrix x - 2 right' x is minimised
    std::vector<double> right_;
};

} // namespace catoptric::measure
