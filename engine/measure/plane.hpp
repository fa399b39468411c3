#pragma once

#include <cstddef>
#include <initializer_list>
#include <vector>

namespace catoptric::measure {

struct ChannelPlane {
    int width = 0;
    int height = 0;
    std::vector<double> values;

    /// Sets the size. Keeps the memory and leaves the values undefined.
    void resize(int columns, int rows) {
        width = columns, height = rows;
        values.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    }
    double* row(int y) { return values.data() + static_cast<std::ptrdiff_t>(y) * width; }
    const double* row(int y) const {
        return values.data() + static_cast<std::ptrdiff_t>(y) * width;
    }
};

/// Filter kernel: weights for the offsets -radius .. radius.
struct FilterKernel {
    int radius = 0;
    std::vector<double> weights;

    explicit FilterKernel(int reach)
        : radius(reach), weights(2 * static_cast<std::size_t>(reach) + 1) {}
    double& operator[](int offset) { return weights[static_cast<std::size_t>(offset + radius)]; }
    double operator[](int offset) const {
        return weights[static_cast<std::size_t>(offset + radius)];
    }
};

/// Writes the convolution of `in` along x to `out`, which must be another plane. `out` lacks
/// `border` columns on each side. `border` is at least the kernel's radius. Costs 2 * radius + 1
/// multiplications a pixel, on one core.
void convolve_x(const ChannelPlane& in, const FilterKernel& kernel, int border, ChannelPlane& out);

struct FilteredPlane {
    const ChannelPlane& plane;
    const FilterKernel& kernel;
};

/// Writes the sum of convolutions along y to `out`. All planes have one size. `out` lacks `border`
/// rows above and below.
void sum_convolutions_y(std::initializer_list<FilteredPlane> parts, int border, ChannelPlane& out);

} // namespace catoptric::measure
