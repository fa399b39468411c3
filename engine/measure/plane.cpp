#include "measure/plane.hpp"

#include <algorithm>

namespace catoptric::measure {
namespace {

/// Four neighbours in a row.
using Four [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
constexpr int kSums = 8; // that stay in registers
constexpr int kBlock = 4 * kSums;

/// Writes the sum of `taps` rows, each times its weight, to `to`; each has `width` values.
CATOPTRIC_WIDE void weigh(const double* const* rows, const double* weights, std::size_t taps,
                          int width, double* to) {
    int x = 0;
    for (; x + kBlock <= width; x += kBlock) {
        Four sums[kSums] = {};
        for (std::size_t tap = 0; tap < taps; ++tap) {
            const Four* row = reinterpret_cast<const Four*>(rows[tap] + x);
            for (int i = 0; i < kSums; ++i) sums[i] += weights[tap] * row[i];
        }
        Four* const there = reinterpret_cast<Four*>(to + x);
        for (int i = 0; i < kSums; ++i) there[i] = sums[i];
    }
    for (; x < width; ++x) {
        double sum = 0;
        for (std::size_t tap = 0; tap < taps; ++tap) sum += weights[tap] * rows[tap][x];
        to[x] = sum;
    }
}

} // namespace

Plane along_x(const Plane& in, const Kernel& kernel) {
    Plane out(in.width, in.height);
    const int radius = kernel.radius;
    std::vector<double> padded(static_cast<std::size_t>(in.width + 2 * radius));
    std::vector<const double*> shifted;
    for (std::size_t tap = 0; tap < kernel.weights.size(); ++tap)
        shifted.push_back(padded.data() + tap);
    for (int y = 0; y < in.height; ++y) {
        const double* from = in.row(y);
        std::fill_n(padded.begin(), radius, from[0]);
        std::copy_n(from, in.width, padded.begin() + radius);
        std::fill_n(padded.end() - radius, radius, from[in.width - 1]);
        weigh(shifted.data(), kernel.weights.data(), shifted.size(), in.width, out.row(y));
    }
    return out;
}

Plane along_y(const Plane& in, const Kernel& kernel) {
    Plane out(in.width, in.height);
    std::vector<const double*> rows(kernel.weights.size());
    for (int y = 0; y < in.height; ++y) {
        for (std::size_t tap = 0; tap < rows.size(); ++tap)
            rows[tap] = in.row(
                std::clamp(y + static_cast<int>(tap) - kernel.radius, 0, in.height - 1));
        weigh(rows.data(), kernel.weights.data(), rows.size(), in.width, out.row(y));
    }
    return out;
}

} // namespace catoptric::measure
