#pragma once

#include "bvh/bvh.hpp"
#include "bvh/copies.hpp"
#include "bvh/simd_box.hpp"
#include "bvh/words.hpp"

#include <array>
#include <optional>

/// Functions that divide the triangles of a tree node between the node's two children.
namespace catoptric::bvh {

/// A triangle while the tree is being built.
struct TriangleReference {
    SimdFloat4 lo; ///< low corner of the box; the fourth element is the triangle's number as a word
    SimdFloat4 hi;

    std::uint32_t number() const { return unpack_number(lo[3]); }
    /// Halves before adding, because the sum itself may overflow.
    SimdFloat4 centre() const { return lo * .5f + hi * .5f; }
    SimdBox box() const { return {lo, hi}; }
};

using TriangleReferences = std::span<TriangleReference>;

/// The references below a node.
struct ReferenceRange {
    std::size_t first = 0, count = 0; ///< place among all references
    bool in_second = false;           ///< lies in the second of the two buffers
    bool has_single_centre =
        false; ///< all centres are equal, copies are gone, and the order is by number
    SimdBox box, centres;

    void add(const TriangleReference& r) {
        box.add_box(r.box()), centres.add_point(r.centre()), ++count;
    }
};

inline constexpr int kBinCount = 16;

/// A map from centres to bins along each axis of the centres' bounds.
struct Binning {
    SimdFloat4 lowest_centre, bins_per_unit;

    explicit Binning(const SimdBox& centres);
    /// Returns the position in units of bins, 0 to kBinCount inclusive. The result is not
    /// finite if the bounds are too small or too large for a float quotient. In that case all
    /// references go to one bin.
    SimdFloat4 position(SimdFloat4 centre) const {
        return (centre - lowest_centre) * bins_per_unit;
    }
};

struct BinnedSplit;

/// The contents of the bins of each axis.
class SplitBins {
public:
    void add(std::span<const TriangleReference> references, const Binning& binning);
    void add(const SplitBins& other);
    std::size_t left_count(const BinnedSplit& split) const;
    std::array<SimdBox, 2> extents(const BinnedSplit& split) const;

private:
    friend std::optional<BinnedSplit> find_binned_split(const SplitBins& bins, std::size_t most);
    std::array<std::array<SimdBox, kBinCount>, 3> extents_{};
    std::array<std::array<std::uint32_t, kBinCount>, 3> counts_{};
};

/// A plane between two bins.
struct BinnedSplit {
    int axis;
    int first_right; ///< the first bin on the right side

    /// Copies the references of each side, in order, to the addresses in `to`. Adds their centres
    /// to `centres`.
    void scatter(std::span<const TriangleReference> references, const Binning& binning,
                 std::array<TriangleReference*, 2> to, std::array<SimdBox, 2>& centres) const;
};

using SplitRanges = std::array<ReferenceRange, 2>;

/// Returns the two ranges of references into which a split divides a node, in the buffer that does
/// not hold the node. `centres`: bounds of the centres on each side.
SplitRanges make_split_ranges(const ReferenceRange& part, const SplitBins& bins,
                              const BinnedSplit& split, const std::array<SimdBox, 2>& centres);

/// Returns the cheapest plane between bins that leaves at most `most` triangles on each side.
/// Returns nothing if no plane does so, for example because one bin holds all references.
std::optional<BinnedSplit> find_binned_split(const SplitBins& bins, std::size_t most);

/// The most references that `find_swept_split` accepts.
inline constexpr std::size_t kMaxSweepTriangles = 8;

/// The cheapest way to cut a list of references in two along an axis.
struct SweptSplit {
    double cost;        ///< sum over the sides of half area times count
    std::size_t middle; ///< index of the first reference on the right
};

/// Sorts references by centre, then by number, along the axis with the cheapest division, and
/// returns that division. Returns nothing if one side would always have more than `most`. Accepts
/// at most kMaxSweepTriangles references.
std::optional<SweptSplit> find_swept_split(TriangleReferences references, std::size_t most);

/// Moves the half with the smaller centres, along the longest axis of their bounds, to the front.
/// Breaks ties by number. Returns the index of the first reference of the other half.
std::size_t partition_at_median(TriangleReferences references, const SimdBox& centres);

/// Keeps one reference for each set of equal triangles, the one with the lowest number. Returns
/// them in order of number. If more triangles share a centre than fit into a leaf, a ray would test
/// every copy: all are at the same t and the lowest number wins.
TriangleReferences remove_copies(TriangleReferences references, std::span<const Triangle> triangles,
                                 CopyScope copies);

} // namespace catoptric::bvh
