#include "bvh/split.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace catoptric::bvh {

namespace {

using Integers = std::int32_t __attribute__((vector_size(16)));

/// Distance of the prefetch, in references. Processors do not prefetch across pages by themselves.
constexpr std::size_t kAhead = 24;

double cost_of(const Extent& extent, std::size_t count) {
    return extent.half_area() * static_cast<double>(count);
}

bool is_before(const TriangleReference& a, const TriangleReference& b, std::size_t axis) {
    const float place_a = a.lo[axis] * .5f + a.hi[axis] * .5f,
                place_b = b.lo[axis] * .5f + b.hi[axis] * .5f;
    return place_a != place_b ? place_a < place_b : a.triangle() < b.triangle();
}

} // namespace

Binning::Binning(const Extent& centres)
    : lo(centres.lo), bins_per_unit(all_lanes(kBinCount) / (centres.hi - centres.lo)) {
    lo[3] = bins_per_unit[3] = 0;
}

void Bins::add(std::span<const TriangleReference> references, const Binning& binning) {
    for (const TriangleReference& r : references) {
        __builtin_prefetch(&r + kAhead);
        // The minimum also sends NaN to the last bin.
        const Integers bin = __builtin_convertvector(
            smaller(all_lanes(kBinCount - 1), binning.place(r.centre())), Integers);
        for (int axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<std::size_t>(bin[axis]);
            extents_[axis][k].add(r.extent());
            ++counts_[axis][k];
        }
    }
}

void Bins::add(const Bins& other) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < kBinCount; ++k) {
            extents_[axis][k].add(other.extents_[axis][k]);
            counts_[axis][k] += other.counts_[axis][k];
        }
}

std::size_t Bins::left_count(const Split& split) const {
    const auto& counts = counts_[split.axis];
    return std::accumulate(counts.begin(), counts.begin() + split.first_right, std::size_t{0});
}

std::array<Extent, 2> Bins::extents(const Split& split) const {
    std::array<Extent, 2> sides;
    for (int k = 0; k < kBinCount; ++k)
        sides[k < split.first_right ? 0 : 1].add(extents_[split.axis][k]);
    return sides;
}

SplitParts sides_of(const ReferenceRange& part, const Bins& bins, const Split& split,
                    const std::array<Extent, 2>& centres) {
    const std::size_t left = bins.left_count(split);
    const std::array<Extent, 2> boxes = bins.extents(split);
    return {ReferenceRange{part.first, left, !part.in_second, false, boxes[0], centres[0]},
            ReferenceRange{part.first + left, part.count - left, !part.in_second, false, boxes[1],
                           centres[1]}};
}

void Split::scatter(std::span<const TriangleReference> references, const Binning& binning,
                    std::array<TriangleReference*, 2> to, std::array<Extent, 2>& centres) const {
    const auto k = static_cast<std::size_t>(axis);
    const float lo = binning.lo[k], bins_per_unit = binning.bins_per_unit[k],
                end = static_cast<float>(first_right);
    TriangleReference *left = to[0], *right = to[1];
    for (const TriangleReference& r : references) {
        __builtin_prefetch(&r + kAhead);
        const Lanes centre = r.centre();
        // Without a branch, because no predictor could foresee it. Without sums in memory, too.
        const bool is_right = !((centre[k] - lo) * bins_per_unit < end);
        *(is_right ? right : left) = r;
        right += is_right, left += !is_right;
        const Lanes away[2] = {all_lanes(0), all_lanes(kInfinity)};
        centres[0].add_moved(centre, away[is_right]);
        centres[1].add_moved(centre, away[!is_right]);
    }
}

std::optional<Split> best_split(const Bins& bins, std::size_t most) {
    std::optional<Split> best;
    double least = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto& extents = bins.extents_[axis];
        const auto& counts = bins.counts_[axis];
        std::array<double, kBinCount> right_cost; // of bins i to kBinCount - 1
        std::array<std::size_t, kBinCount> right_count;
        Extent right;
        std::size_t count = 0;
        for (std::size_t i = kBinCount; i-- > 1;) {
            right.add(extents[i]), count += counts[i];
            right_count[i] = count;
            right_cost[i] = cost_of(right, count);
        }
        Extent left;
        count = 0;
        for (std::size_t i = 1; i < kBinCount; ++i) {
            left.add(extents[i - 1]), count += counts[i - 1];
            if (count == 0 || right_count[i] == 0) continue;
            if (count > most || right_count[i] > most) continue;
            const double cost = cost_of(left, count) + right_cost[i];
            if (best && !(cost < least)) continue;
            best = Split{static_cast<int>(axis), static_cast<int>(i)};
            least = cost;
        }
    }
    return best;
}

std::optional<Division> sweep(References references, std::size_t most) {
    const std::size_t count = references.size();
    std::array<TriangleReference, kSweepCount> sorted, best_order;
    std::optional<Division> best;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < count; ++i) {
            std::size_t k = i;
            for (; k > 0 && is_before(references[i], sorted[k - 1], axis); --k)
                sorted[k] = sorted[k - 1];
            sorted[k] = references[i];
        }
        std::array<double, kSweepCount> right_cost;
        Extent right;
        for (std::size_t i = count; i-- > 1;) {
            right.add(sorted[i].extent());
            right_cost[i] = cost_of(right, count - i);
        }
        Extent left;
        bool is_best = false;
        for (std::size_t i = 1; i < count; ++i) {
            left.add(sorted[i - 1].extent());
            if (i > most || count - i > most) continue;
            const double cost = cost_of(left, i) + right_cost[i];
            if (best && !(cost < best->cost)) continue;
            best = Division{cost, i};
            is_best = true;
        }
        if (is_best) best_order = sorted;
    }
    if (best) std::copy_n(best_order.begin(), count, references.begin());
    return best;
}

std::size_t halve(References references, const Extent& centres) {
    const vec3 size = centres.box().extent();
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = references.size() / 2;
    std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(middle),
                     references.end(),
                     [axis](const TriangleReference& a, const TriangleReference& b) {
                         return is_before(a, b, axis);
                     });
    return middle;
}

References without_copies(References references, std::span<const Triangle> triangles,
                          Copies copies) {
    const auto what = [&](const TriangleReference& r) {
        const Triangle& t = triangles[r.triangle()];
        return std::array{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    };
    const auto whose = [&](const TriangleReference& r) {
        const Triangle& t = triangles[r.triangle()];
        const bool is_told_apart = copies == Copies::of_object ||
                                   (t.flags & (kMasked | kSphere)) != 0;
        return std::pair{is_told_apart ? t.object : 0, t.flags};
    };
    std::ranges::sort(references, [&](const TriangleReference& a, const TriangleReference& b) {
        return std::tuple{what(a), whose(a), a.triangle()} <
               std::tuple{what(b), whose(b), b.triangle()};
    });
    const auto left_out = std::ranges::unique(
        references, [&](const TriangleReference& a, const TriangleReference& b) {
            return what(a) == what(b) && whose(a) == whose(b);
        });
    references = references.first(references.size() - left_out.size());
    std::ranges::sort(references, {}, &TriangleReference::triangle);
    return references;
}

} // namespace catoptric::bvh
