#include "measure/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptric::measure {

LeastSquares::LeastSquares(std::size_t unknowns)
    : matrix_(unknowns, std::vector<double>(unknowns)), right_(unknowns) {}

void LeastSquares::add(std::span<const double> row, double target, double sign) {
    for (std::size_t i = 0; i < right_.size(); ++i) {
        right_[i] += sign * row[i] * target;
        for (std::size_t j = 0; j < right_.size(); ++j) matrix_[i][j] += sign * row[i] * row[j];
    }
}

std::vector<double> LeastSquares::solve() const {
    constexpr int kMaxSweeps = 200'000;
    constexpr double kConvergenceLimit = 1e-12;
    const std::size_t count = right_.size();
    std::vector<double> found(count);
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
        double change = 0, size = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double diagonal = matrix_[i][i];
            if (!(diagonal > 0)) continue; // no equation has this unknown
            double rest = right_[i];
            for (std::size_t j = 0; j < count; ++j)
                if (j != i) rest -= matrix_[i][j] * found[j];
            const double next = std::max(0.0, rest / diagonal);
            // A change is weighted by its effect on the equations.
            change = std::max(change, std::abs(next - found[i]) * std::sqrt(diagonal));
            size = std::max(size, next * std::sqrt(diagonal));
            found[i] = next;
        }
        if (change <= kConvergenceLimit * size) break;
    }
    return found;
}

double LeastSquares::predict_without(std::span<const double> row) const {
    LeastSquares others = *this;
    others.add(row, 1, -1);
    const std::vector<double> found = others.solve();
    return std::inner_product(row.begin(), row.end(), found.begin(), 0.0);
}

} // namespace catoptric::measure
