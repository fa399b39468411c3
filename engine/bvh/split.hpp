#pragma once

#include "bvh/bvh.hpp"
#include "bvh/copies.hpp"
#include "bvh/lanes.hpp"
#include "bvh/words.hpp"

#include <array>
#include <optional>

/// How a node's triangles are divided between its children.
namespace catoptric::bvh {

/// A triangle while the tree is being built.
struct Reference {
    Lanes lo; ///< of its box; the fourth is the triangle's number as a word
    Lanes hi;

    std::uint32_t triangle() const { return number_of(lo[3]); }
    /// Of its box; the sum itself may overflow.
    Lanes centre() const { return lo * .5f + hi * .5f; }
    Extent extent() const { return {lo, hi}; }
};

using References = std::span<Reference>;

/// Triangles that a subtree is made of.
struct Part {
    std::size_t first = 0, count = 0; ///< among all references
    bool in_second = false;           ///< of the two buffers
    bool is_heap = false;             ///< all centres are one; no copies, and in order of number
    Extent box, centres;

    void add(const Reference& r) { box.add(r.extent()), centres.add(r.centre()), ++count; }
};

inline constexpr int kBinCount = 16;

/// Maps centres to bins along each axis of the centres' bounds.
struct Binning {
    Lanes lo, bins_per_unit;

    explicit Binning(const Extent& centres);
    /// In units of bins, from 0 to kBinCount with its end. Not finite where bounds are too small or
    /// too large for a float's quotient: then all are in one bin.
    Lanes place(Lanes centre) const { return (centre - lo) * bins_per_unit; }
};

struct Split;

/// What is in the bins of each axis.
class Bins {
public:
    void add(std::span<const Reference> references, const Binning& binning);
    void add(const Bins& other);
    std::size_t left_count(const Split& split) const;
    /// Boxes of the sides.
    std::array<Extent, 2> extents(const Split& split) const;

private:
    friend std::optional<Split> best_split(const Bins& bins, std::size_t most);
    std::array<std::array<Extent, kBinCount>, 3> extents_{};
    std::array<std::array<std::uint32_t, kBinCount>, 3> counts_{};
};

/// A plane between bins.
struct Split {
    int axis;
    int first_right; ///< bins from here on go right

    /// Copies each side's references, in their order, to where `to` says; adds their centres.
    void scatter(std::span<const Reference> references, const Binning& binning,
                 std::array<Reference*, 2> to, std::array<Extent, 2>& centres) const;
};

using Sides = std::array<Part, 2>;

/// What a part becomes, in the other buffer, with bounds of the centres on each side.
Sides sides_of(const Part& part, const Bins& bins, const Split& split,
               const std::array<Extent, 2>& centres);

/// The cheapest of the planes between the bins, neither side with more than `most` triangles; none
/// where one bin holds all.
std::optional<Split> best_split(const Bins& bins, std::size_t most);

/// References that `sweep` looks at, at most.
inline constexpr std::size_t kSweepCount = 8;

/// The cheapest of all divisions along an axis.
struct Division {
    double cost;        ///< sum over the sides of half the area times count
    std::size_t middle; ///< the first on the right
};

/// Sorts references by centre, then number, along the axis along which their cheapest division is;
/// none where a side would have more than `most`. At most kSweepCount of them.
std::optional<Division> sweep(References references, std::size_t most);

/// Puts the half with the smaller centres along the longest axis of their bounds first; by number
/// where they tie.
std::size_t halve(References references, const Extent& centres);

/// One reference of each triangle, the lowest number, in order of number: where more lie around one
/// centre than a leaf holds, a ray would have to look at all copies, since all are at the same t,
/// and the lowest number wins.
References without_copies(References references, std::span<const Triangle> triangles,
                          Copies copies);

} // namespace catoptric::bvh
