#include "bvh/split.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace catoptric::bvh {

namespace {

using SimdInt4 = std::int32_t __attribute__((vector_size(16)));

/// Distance of the prefetch, in references. Processors do not prefetch across pages by themselves.
constexpr std::size_t kReferencePrefetchDistance = 24;

double compute_split_cost(const SimdBox& extent, std::size_t count) {
    return extent.half_surface_area() * static_cast<double>(count);
}

bool is_centroid_before_on_axis(const TriangleReference& a, const TriangleReference& b,
                                std::size_t axis) {
    const float place_a = a.lo[axis] * .5f + a.hi[axis] * .5f,
                place_b = b.lo[axis] * .5f + b.hi[axis] * .5f;
    return place_a != place_b ? place_a < place_b
                              : a.triangle_index_of_reference() < b.triangle_index_of_reference();
}

} // namespace

CentroidToBinMapping::CentroidToBinMapping(const SimdBox& centres)
    : lowest_centre(centres.lo),
      bins_per_unit(broadcast_simd(kSplitBinCount) / (centres.hi - centres.lo)) {
    lowest_centre[3] = bins_per_unit[3] = 0;
}

void SahSplitBins::add_references(std::span<const TriangleReference> references,
                                  const CentroidToBinMapping& binning) {
    for (const TriangleReference& r : references) {
        __builtin_prefetch(&r + kReferencePrefetchDistance);
        // The minimum also puts NaN into the last bin.
        const SimdInt4 bin = __builtin_convertvector(
            simd_min(broadcast_simd(kSplitBinCount - 1),
                     binning.fractional_bin_of_centroid(r.bounding_box_centre())),
            SimdInt4);
        for (int axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<std::size_t>(bin[axis]);
            extents_[axis][k].add_box(r.triangle_bounding_box());
            ++counts_[axis][k];
        }
    }
}

void SahSplitBins::add_bins(const SahSplitBins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < kSplitBinCount; ++k) {
            extents_[axis][k].add_box(other.extents_[axis][k]);
            counts_[axis][k] += other.counts_[axis][k];
        }
}

std::size_t SahSplitBins::left_triangle_count_of_split(const BinnedSahSplit& split) const {
    const auto& counts = counts_[split.axis];
    return std::accumulate(counts.begin(), counts.begin() + split.first_right, std::size_t{0});
}

std::array<SimdBox, 2> SahSplitBins::extents(const BinnedSahSplit& split) const {
    std::array<SimdBox, 2> sides;
    for (int k = 0; k < kSplitBinCount; ++k)
        sides[k < split.first_right ? 0 : 1].add_box(extents_[split.axis][k]);
    return sides;
}

SplitTriangleRanges make_split_ranges(const TriangleReferenceSpanRange& part,
                                      const SahSplitBins& bins, const BinnedSahSplit& split,
                                      const std::array<SimdBox, 2>& centres) {
    const std::size_t left = bins.left_triangle_count_of_split(split);
    const std::array<SimdBox, 2> boxes = bins.extents(split);
    return {
        TriangleReferenceSpanRange{part.first, left, !part.in_second, false, boxes[0], centres[0]},
        TriangleReferenceSpanRange{part.first + left, part.count - left, !part.in_second, false,
                                   boxes[1], centres[1]}};
}

void BinnedSahSplit::scatter_references_to_sides(std::span<const TriangleReference> references,
                                                 const CentroidToBinMapping& binning,
                                                 std::array<TriangleReference*, 2> to,
                                                 std::array<SimdBox, 2>& centres) const {
    const auto k = static_cast<std::size_t>(axis);
    const float lo = binning.lowest_centre[k], bins_per_unit = binning.bins_per_unit[k],
                end = static_cast<float>(first_right);
    TriangleReference *left = to[0], *right = to[1];
    for (const TriangleReference& r : references) {
        __builtin_prefetch(&r + kReferencePrefetchDistance);
        const SimdFloat4 centre = r.bounding_box_centre();
        // Computed without a branch, because branch prediction would fail half of the time, and
        // with sums in registers.
        const bool is_right = !((centre[k] - lo) * bins_per_unit < end);
        *(is_right ? right : left) = r;
        right += is_right, left += !is_right;
        const SimdFloat4 away[2] = {broadcast_simd(0), broadcast_simd(kInfinityFloat)};
        centres[0].add_point_unless_infinite(centre, away[is_right]);
        centres[1].add_point_unless_infinite(centre, away[!is_right]);
    }
}

std::optional<BinnedSahSplit> find_best_binned_sah_split(const SahSplitBins& bins,
                                                         std::size_t most) {
    std::optional<BinnedSahSplit> best;
    double least = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& extents = bins.extents_[axis];
        const auto& counts = bins.counts_[axis];
        std::array<double, kSplitBinCount> right_cost; // cost of bins i to kSplitBinCount - 1
        std::array<std::size_t, kSplitBinCount> right_count;
        SimdBox right;
        std::size_t count = 0;
        for (std::size_t i = kSplitBinCount; i-- > 1;) {
            right.add_box(extents[i]), count += counts[i];
            right_count[i] = count;
            right_cost[i] = compute_split_cost(right, count);
        }
        SimdBox left;
        count = 0;
        for (std::size_t i = 1; i < kSplitBinCount; ++i) {
            left.add_box(extents[i - 1]), count += counts[i - 1];
            if (count == 0 || right_count[i] == 0) continue;
            if (count > most || right_count[i] > most) continue;
            const double cost = compute_split_cost(left, count) + right_cost[i];
            if (best && !(cost < least)) continue;
            best = BinnedSahSplit{static_cast<int>(axis), static_cast<int>(i)};
            least = cost;
        }
    }
    return best;
}

std::optional<SweptSahSplit> find_best_sah_split_by_sweep(TriangleReferences references,
                                                          std::size_t most) {
    const std::size_t count = references.size();
    std::array<TriangleReference, kMaxSweepTriangles> sorted, best_order;
    std::optional<SweptSahSplit> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t k = i;
            for (; k > 0 && is_centroid_before_on_axis(references[i], sorted[k - 1], axis); --k)
                sorted[k] = sorted[k - 1];
            sorted[k] = references[i];
        }
        std::array<double, kMaxSweepTriangles> right_cost;
        SimdBox right;
        for (std::size_t i = count; i-- > 1;) {
            right.add_box(sorted[i].triangle_bounding_box());
            right_cost[i] = compute_split_cost(right, count - i);
        }
        SimdBox left;
        bool is_best = false;
        for (std::size_t i = 1; i < count; ++i) {
            left.add_box(sorted[i - 1].triangle_bounding_box());
            if (i > most || count - i > most) continue;
            const double cost = compute_split_cost(left, i) + right_cost[i];
            if (best && !(cost < best->cost)) continue;
            best = SweptSahSplit{cost, i};
            is_best = true;
        }
        if (is_best) best_order = sorted;
    }
    if (best) std::copy_n(best_order.begin(), count, references.begin());
    return best;
}

std::size_t partition_triangles_at_median(TriangleReferences references, const SimdBox& centres) {
    const vec3 size = centres.to_bounding_box().extent();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = references.size() / 2;
    std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(middle),
                     references.end(),
                     [axis](const TriangleReference& a, const TriangleReference& b) {
                         return is_centroid_before_on_axis(a, b, axis);
                     });
    return middle;
}

TriangleReferences remove_duplicate_triangles(TriangleReferences references,
                                              std::span<const Triangle> triangles,
                                              DuplicateTriangleSearchScope copies) {
    const auto what = [&](const TriangleReference& r) {
        const Triangle& t = triangles[r.triangle_index_of_reference()];
        return std::array{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    };
    const auto whose = [&](const TriangleReference& r) {
        const Triangle& t = triangles[r.triangle_index_of_reference()];
        const bool is_told_apart = copies == DuplicateTriangleSearchScope::within_object ||
                                   (t.flags & (kAlphaMaskedFlag | kTriangleApproximatesSphereFlag |
                                               kTintsShadowFlag)) != 0;
        return std::pair{is_told_apart ? t.object : 0, t.flags};
    };
    std::ranges::sort(references, [&](const TriangleReference& a, const TriangleReference& b) {
        return std::tuple{what(a), whose(a), a.triangle_index_of_reference()} <
               std::tuple{what(b), whose(b), b.triangle_index_of_reference()};
    });
    const auto left_out = std::ranges::unique(
        references, [&](const TriangleReference& a, const TriangleReference& b) {
            return what(a) == what(b) && whose(a) == whose(b);
        });
    references = references.first(references.size() - left_out.size());
    std::ranges::sort(references, {}, &TriangleReference::triangle_index_of_reference);
    return references;
}

} // namespace catoptric::bvh
