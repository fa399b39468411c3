#pragma once

#include <cstddef>
#include <vector>

/// Marks a function whose loops are also compiled for processors with AVX2, chosen at run time.
/// Both versions give the same bits: no product is fused with a sum.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
    !defined(__SANITIZE_ADDRESS__)
#define CATOPTRIC_WIDE [[gnu::target_clones("avx2", "default")]]
#else
#define CATOPTRIC_WIDE
#endif

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

/// Convolution along x or y; beyond the border the outermost pixel goes on. Costs
/// 2 * radius + 1 multiplications a pixel, on one core.
Plane along_x(const Plane& in, const Kernel& kernel);
Plane along_y(const Plane& in, const Kernel& kernel);

} // namespace catoptric::measure
