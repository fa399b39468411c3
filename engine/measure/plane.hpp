#pragma once

#include "core/parallel.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace catoptric::measure {

/// One channel of a picture.
struct Plane {
    int width = 0;
    int height = 0;
    std::vector<double> values;

    Plane(int columns, int rows)
        : width(columns), height(rows),
          values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}
    double* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
    const double* row(int y) const {
        return values.data() + static_cast<std::ptrdiff_t>(y) * width;
    }
};

/// Weights for offsets -radius .. radius.
struct Kernel {
    int radius = 0;
    std::vector<double> weights;

    explicit Kernel(int reach) : radius(reach), weights(2 * static_cast<std::size_t>(reach) + 1) {}
    double& operator[](int offset) { return weights[static_cast<std::size_t>(offset + radius)]; }
    double operator[](int offset) const {
        return weights[static_cast<std::size_t>(offset + radius)];
    }
};

/// Calls body(y) for every row, on all cores; rows are independent, so the result does not depend
/// on how many there are.
template <typename Body>
void for_rows(int height, const Body& body) {
    constexpr int kRows = 16;
    in_parallel(static_cast<std::size_t>((height + kRows - 1) / kRows), all_threads(),
                [&](std::size_t i) {
                    const int first = static_cast<int>(i) * kRows;
                    for (int y = first; y < std::min(first + kRows, height); ++y) body(y);
                });
}

/// Convolution along x or y; beyond the border the outermost pixel goes on. Costs
/// 2 * radius + 1 multiplications a pixel.
Plane along_x(const Plane& in, const Kernel& kernel);
Plane along_y(const Plane& in, const Kernel& kernel);

} // namespace catoptric::measure
