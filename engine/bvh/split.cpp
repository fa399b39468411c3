#include "bvh/split.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace catoptric::bvh {

namespace {

Box centre_bounds(References references) {
    Box box;
    for (const Reference& r : references) box.add(r.centre);
    return box;
}

struct Bin {
    Box box;
    std::size_t count = 0;
    void add(const Bin& other) { box.add(other.box), count += other.count; }
    double cost() const { return count == 0 ? 0 : area(box) * static_cast<double>(count); }
};

} // namespace

std::optional<Split> best_split(References references, std::size_t most) {
    std::optional<Split> best;
    const Box centres = centre_bounds(references);
    for (int axis = 0; axis < 3; ++axis) {
        if (!(centres.lo[axis] < centres.hi[axis])) continue;
        const Binning binning(centres, axis);
        std::array<Bin, kBinCount> bins;
        for (const Reference& r : references) {
            Bin& bin = bins[static_cast<std::size_t>(binning.bin(r))];
            bin.box.add(r.box), ++bin.count;
        }
        std::array<Bin, kBinCount> right; // right[i]: bins i and above
        right.back() = bins.back();
        for (std::size_t i = kBinCount - 1; i-- > 1;) {
            right[i] = bins[i];
            right[i].add(right[i + 1]);
        }
        Bin left;
        for (std::size_t i = 1; i < kBinCount; ++i) {
            left.add(bins[i - 1]);
            if (left.count == 0 || right[i].count == 0) continue;
            if (left.count > most || right[i].count > most) continue;
            const double cost = left.cost() + right[i].cost();
            if (!best || cost < best->cost) best = Split{binning, static_cast<int>(i), cost};
        }
    }
    return best;
}

std::size_t halve(References references) {
    const vec3 size = centre_bounds(references).extent();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t middle = references.size() / 2;
    std::nth_element(references.begin(), references.begin() + static_cast<std::ptrdiff_t>(middle),
                     references.end(), [axis](const Reference& a, const Reference& b) {
                         if (a.centre[axis] != b.centre[axis])
                             return a.centre[axis] < b.centre[axis];
                         return a.triangle < b.triangle;
                     });
    return middle;
}

References without_copies(References references, std::span<const Triangle> triangles) {
    const auto in_one_place = [&](const Reference& r) { return r.centre == references[0].centre; };
    if (references.size() <= kMaxLeaf || !std::ranges::all_of(references, in_one_place))
        return references;
    const auto what = [&](const Reference& r) {
        const Triangle& t = triangles[r.triangle];
        return std::array{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    };
    const auto whose = [&](const Reference& r) {
        const Triangle& t = triangles[r.triangle];
        return std::pair{t.object, t.flags};
    };
    std::ranges::sort(references, [&](const Reference& a, const Reference& b) {
        return std::tuple{what(a), whose(a), a.triangle} <
               std::tuple{what(b), whose(b), b.triangle};
    });
    const auto copies = std::ranges::unique(references,
                                            [&](const Reference& a, const Reference& b) {
                                                return what(a) == what(b) && whose(a) == whose(b);
                                            });
    return references.first(references.size() - copies.size());
}

} // namespace catoptric::bvh
