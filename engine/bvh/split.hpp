#pragma once

#include "bvh/box.hpp"

#include <algorithm>
#include <optional>

/// How a node's triangles are divided between its children.
namespace catoptric::bvh {

/// A triangle while the tree is being built.
struct Reference {
    Box box;
    vec3 centre;
    std::uint32_t triangle;
};

using References = std::span<Reference>;

inline Box bounds(References references) {
    Box box;
    for (const Reference& r : references) box.add(r.box);
    return box;
}

inline constexpr int kBinCount = 16;

/// Maps centres to bins along one axis of the centres' bounds.
struct Binning {
    int axis = 0;
    double lo = 0;
    double bins_per_unit = 0;

    Binning(const Box& centres, int along)
        : axis(along), lo(centres.lo[along]),
          bins_per_unit(kBinCount / (static_cast<double>(centres.hi[along]) - lo)) {}
    int bin(const Reference& r) const {
        const double place = (static_cast<double>(r.centre[axis]) - lo) * bins_per_unit;
        return std::min(static_cast<int>(place), kBinCount - 1);
    }
};

struct Split {
    Binning binning;
    int first_right; ///< bins from here on go right
    double cost;     ///< sum over the sides of area times count
};

/// The cheapest of the planes between the bins, neither side with more than `most` triangles; none
/// where all centres are one. Costs O(n).
std::optional<Split> best_split(References references, std::size_t most);

/// Puts the half with the smaller centres along the longest axis first; by number where they tie.
std::size_t halve(References references);

/// One reference of each triangle where there are more of them in one place than a leaf holds: a
/// ray would have to look at all copies, since all are at the same t, and it cannot tell those of
/// one object apart. The lowest number stays.
References without_copies(References references, std::span<const Triangle> triangles);

} // namespace catoptric::bvh
