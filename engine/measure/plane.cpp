#include "measure/plane.hpp"

#include "measure/wide.hpp"

namespace catoptric::measure {
namespace {

/// Four adjacent values of a row.
using SimdDouble4 [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
constexpr int kRegisterSums = 8; // sums that stay in registers
constexpr int kBlockColumns = 4 * kRegisterSums;

/// Writes the weighted sum of `taps` rows to `to`. Each row has `width` values.
CATOPTRIC_WIDE void add_weighted_rows(const double* const* rows, const double* weights,
                                      std::size_t taps, int width, double* to) {
    int x = 0;
    for (; x + kBlockColumns <= width; x += kBlockColumns) {
        SimdDouble4 sums[kRegisterSums] = {};
        for (std::size_t tap = 0; tap < taps; ++tap) {
            const SimdDouble4* row = reinterpret_cast<const SimdDouble4*>(rows[tap] + x);
#pragma GCC unroll 8 // -O2 alone would keep the sums in memory
            for (int i = 0; i < kRegisterSums; ++i) sums[i] += weights[tap] * row[i];
        }
        SimdDouble4* const there = reinterpret_cast<SimdDouble4*>(to + x);
#pragma GCC unroll 8
        for (int i = 0; i < kRegisterSums; ++i) there[i] = sums[i];
    }
    for (; x < width; ++x) {
        double sum = 0;
        for (std::size_t tap = 0; tap < taps; ++tap) sum += weights[tap] * rows[tap][x];
        to[x] = sum;
    }
}

} // namespace

void convolve_x(const ChannelPlane& in, const FilterKernel& kernel, int border, ChannelPlane& out) {
    out.resize(in.width - 2 * border, in.height);
    std::vector<const double*> shifted(kernel.weights.size());
    for (int y = 0; y < in.height; ++y) {
        const double* const first = in.row(y) + border - kernel.radius;
        for (std::size_t tap = 0; tap < shifted.size(); ++tap) shifted[tap] = first + tap;
        add_weighted_rows(shifted.data(), kernel.weights.data(), shifted.size(), out.width,
                          out.row(y));
    }
}

void sum_convolutions_y(std::initializer_list<FilteredPlane> parts, int border, ChannelPlane& out) {
    const ChannelPlane& one = parts.begin()->plane;
    out.resize(one.width, one.height - 2 * border);
    std::vector<const double*> rows;
    std::vector<double> weights;
    for (const FilteredPlane& part : parts)
        weights.insert(weights.end(), part.kernel.weights.begin(), part.kernel.weights.end());
    for (int y = 0; y < out.height; ++y) {
        rows.clear();
        for (const FilteredPlane& part : parts)
            for (int offset = -part.kernel.radius; offset <= part.kernel.radius; ++offset)
                rows.push_back(part.plane.row(y + border + offset));
        add_weighted_rows(rows.data(), weights.data(), rows.size(), out.width, out.row(y));
    }
}

} // namespace catoptric::measure
