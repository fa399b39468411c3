#include "bvh/split.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace catoptric::bvh {

namespace {

using SimdInt4 = std::int32_t __attribute__((vector_size(16)));

/// Distance of the prefetch, in references. Processors do not prefetch across pages by themselves.
constexpr std::size_t kPrefetchDistance = 24;

double split_cost(const SimdBox& extent, std::size_t count) {
    return extent.half_area() * static_cast<double>(count);
}

bool is_before(const TriangleReference& a, const TriangleReference& b, std::size_t axis) {
    const float place_a = a.lo[axis] * .5f + a.hi[axis] * .5f,
                place_b = b.lo[axis] * .5f + b.hi[axis] * .5f;
    return place_a != place_b ? place_a < place_b : a.number() < b.number();
}

} // namespace

Binning::Binning(const SimdBox& centres)
    : lowest_centre(centres.lo),
      bins_per_unit(broadcast_simd(kBinCount) / (centres.hi - centres.lo)) {
    lowest_centre[3] = bins_per_unit[3] = 0;
}

void SplitBins::add(std::span<const TriangleReference> references, const Binning& binning) {
    for (const TriangleReference& r : references) {
        __builtin_prefetch(&r + kPrefetchDistance);
        // The minimum also puts NaN into the last bin.
        const SimdInt4 bin = __builtin_convertvector(
            simd_min(broadcast_simd(kBinCount - 1), binning.position(r.centre())), SimdInt4);
        for (int axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<std::size_t>(bin[axis]);
            extents_[axis][k].add_box(r.box());
            ++counts_[axis][k];
        }
    }
}

void SplitBins::add(const SplitBins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < kBinCount; ++k) {
            extents_[axis][k].add_box(other.extents_[axis][k]);
            counts_[axis][k] += other.counts_[axis][k];
        }
}

std::size_t SplitBins::left_count(const BinnedSplit& split) const {
    const auto& counts = counts_[split.axis];
    return std::accumulate(counts.begin(), counts.begin() + split.first_right, std::size_t{0});
}

std::array<SimdBox, 2> SplitBins::extents(const BinnedSplit& split) const {
    std::array<SimdBox, 2> sides;
    for (int k = 0; k < kBinCount; ++k)
        sides[k < split.first_right ? 0 : 1].add_box(extents_[split.axis][k]);
    return sides;
}

SplitRanges make_split_ranges(const ReferenceRange& part, const SplitBins& bins,
                              const BinnedSplit& split, const std::array<SimdBox, 2>& centres) {
    const std::size_t left = bins.left_count(split);
    const std::array<SimdBox, 2> boxes = bins.extents(split);
    return {ReferenceRange{part.first, left, !part.in_second, false, boxes[0], centres[0]},
            ReferenceRange{part.first + left, part.count - left, !part.in_second, false, boxes[1],
                           centres[1]}};
}

void BinnedSplit::scatter(std::span<const TriangleReference> references, const Binning& binning,
                          std::array<TriangleReference*, 2> to,
                          std::array<SimdBox, 2>& centres) const {
    const auto k = static_cast<std::size_t>(axis);
    const float lo = binning.lowest_centre[k], bins_per_unit = binning.bins_per_unit[k],
                end = static_cast<float>(first_right);
    TriangleReference *left = to[0], *right = to[1];
    for (const TriangleReference& r : references) {
        __builtin_prefetch(&r + kPrefetchDistance);
        const SimdFloat4 centre = r.centre();
        // Computed without a branch, because branch prediction would fail half of the time, and
        // with sums in registers.
        const bool is_right = !((centre[k] - lo) * bins_per_unit < end);
        *(is_right ? right : left) = r;
        right += is_right, left += !is_right;
        const SimdFloat4 away[2] = {broadcast_simd(0), broadcast_simd(kInfinityFloat)};
        centres[0].add_point_unless(centre, away[is_right]);
        centres[1].add_point_unless(centre, away[!is_right]);
    }
}

std::optional<BinnedSplit> find_binned_split(const SplitBins& bins, std::size_t most) {
    std::optional<BinnedSplit> best;
    double least = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& extents = bins.extents_[axis];
        const auto& counts = bins.counts_[axis];
        std::array<double, kBinCount> right_cost; // cost of bins i to kBinCount - 1
        std::array<std::size_t, kBinCount> right_count;
        SimdBox right;
        std::size_t count = 0;
        for (std::size_t i = kBinCount; i-- > 1;) {
            right.add_box(extents[i]), count += counts[i];
            right_count[i] = count;
            right_cost[i] = split_cost(right, count);
        }
        SimdBox left;
        count = 0;
        for (std::size_t i = 1; i < kBinCount; ++i) {
            left.add_box(extents[i - 1]), count += counts[i - 1];
            if (count == 0 || right_count[i] == 0) continue;
            if (count > most || right_count[i] > most) continue;
            const double cost = split_cost(left, count) + right_cost[i];
            if (best && !(cost < least)) continue;
            best = BinnedSplit{static_cast<int>(axis), static_cast<int>(i)};
            least = cost;
        }
    }
    return best;
}

std::optional<SweptSplit> find_swept_split(TriangleReferences references, std::size_t most) {
    const std::size_t count = references.size();
    std::array<TriangleReference, kMaxSweepTriangles> sorted, best_order;
    std::optional<SweptSplit> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t k = i;
            for (; k > 0 && is_before(references[i], sorted[k - 1], axis); --k)
                sorted[k] = sorted[k - 1];
            sorted[k] = references[i];
        }
        std::array<double, kMaxSweepTriangles> right_cost;
        SimdBox right;
        for (std::size_t i = count; i-- > 1;) {
            right.add_box(sorted[i].box());
            right_cost[i] = split_cost(right, count - i);
        }
        SimdBox left;
        bool is_best = false;
        for (std::size_t i = 1; i < count; ++i) {
            left.add_box(sorted[i - 1].box());
            if (i > most || count - i > most) continue;
            const double cost = split_cost(left, i) + right_cost[i];
            if (best && !(cost < best->cost)) continue;
            best = SweptSplit{cost, i};
            is_best = true;
        }
        if (is_best) best_order = sorted;
    }
    if (best) std::copy_n(best_order.begin(), count, references.begin());
    return best;
}

std::size_t partition_at_median(TriangleReferences references, const SimdBox& centres) {
    const vec3 size = centres.to_bounds().extent();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = references.size() / 2;
    std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(middle),
                     references.end(),
                     [axis](const TriangleReference& a, const TriangleReference& b) {
                         return is_before(a, b, axis);
                     });
    return middle;
}

TriangleReferences remove_copies(TriangleReferences references, std::span<const Triangle> triangles,
                                 CopyScope copies) {
    const auto what = [&](const TriangleReference& r) {
        const Triangle& t = triangles[r.number()];
        return std::array{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    };
    const auto whose = [&](const TriangleReference& r) {
        const Triangle& t = triangles[r.number()];
        const bool is_told_apart = copies == CopyScope::within_object ||
                                   (t.flags & (kAlphaMaskedFlag | kStandsForSphereFlag |
                                               kTintsShadowFlag)) != 0;
        return std::pair{is_told_apart ? t.object : 0, t.flags};
    };
    std::ranges::sort(references, [&](const TriangleReference& a, const TriangleReference& b) {
        return std::tuple{what(a), whose(a), a.number()} <
               std::tuple{what(b), whose(b), b.number()};
    });
    const auto left_out = std::ranges::unique(
        references, [&](const TriangleReference& a, const TriangleReference& b) {
            return what(a) == what(b) && whose(a) == whose(b);
        });
    references = references.first(references.size() - left_out.size());
    std::ranges::sort(references, {}, &TriangleReference::number);
    return references;
}

} // namespace catoptric::bvh
