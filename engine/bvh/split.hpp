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

    std::uint32_t triangle_index_of_reference() const { return unpack_number(lo[3]); }
    /// Returns the centre of the box. Halves before adding, because the sum itself may overflow.
    SimdFloat4 bounding_box_centre() const { return lo * .5f + hi * .5f; }
    SimdBox triangle_bounding_box() const { return {lo, hi}; }
};

using TriangleReferences = std::span<TriangleReference>;

/// The references below a node.
struct TriangleReferenceSpanRange {
    std::size_t first = 0, count = 0; ///< place among all references
    bool in_second = false;           ///< lies in the second of the two buffers
    bool has_single_centre =
        false; ///< all centres are equal, copies are gone, and the order is by number
    SimdBox box, centres;

    void add_reference(const TriangleReference& r) {
        box.add_box(r.triangle_bounding_box()), centres.add_point(r.bounding_box_centre()), ++count;
    }
};

inline constexpr int kSplitBinCount = 16;

/// A map from centres to bins along each axis of the centres' bounds.
struct CentroidToBinMapping {
    SimdFloat4 lowest_centre, bins_per_unit;

    explicit CentroidToBinMapping(const SimdBox& centres);
    /// Returns the position in units of bins, 0 to kSplitBinCount inclusive. The result is not
    /// finite if the bounds are too small or too large for a float quotient. In that case all
    /// references go to one bin.
    SimdFloat4 fractional_bin_of_centroid(SimdFloat4 centre) const {
        return (centre - lowest_centre) * bins_per_unit;
    }
};

struct BinnedSahSplit;

/// The contents of the bins of each axis.
class SahSplitBins {
public:
    void add_references(std::span<const TriangleReference> references,
                        const CentroidToBinMapping& binning);
    void add_bins(const SahSplitBins& other);
    std::size_t left_triangle_count_of_split(const BinnedSahSplit& split) const;
    /// Returns the bounds of both sides.
    std::array<SimdBox, 2> extents(const BinnedSahSplit& split) const;

private:
    friend std::optional<BinnedSahSplit> find_best_binned_sah_split(const SahSplitBins& bins,
                                                                    std::size_t most);
    std::array<std::array<SimdBox, kSplitBinCount>, 3> extents_{};
    std::array<std::array<std::uint32_t, kSplitBinCount>, 3> counts_{};
};

/// A plane between two bins.
struct BinnedSahSplit {
    int axis;
    int first_right; ///< the first bin on the right side

    /// Copies the references of each side, in order, to the addresses in `to`. Adds their centres
    /// to `centres`.
    void scatter_references_to_sides(std::span<const TriangleReference> references,
                                     const CentroidToBinMapping& binning,
                                     std::array<TriangleReference*, 2> to,
                                     std::array<SimdBox, 2>& centres) const;
};

using SplitTriangleRanges = std::array<TriangleReferenceSpanRange, 2>;

/// Returns the two ranges of references into which a split divides a node, in the buffer that does
/// not hold the node. `centres`: bounds of the centres on each side.
SplitTriangleRanges make_split_ranges(const TriangleReferenceSpanRange& part,
                                      const SahSplitBins& bins, const BinnedSahSplit& split,
                                      const std::array<SimdBox, 2>& centres);

/// Returns the cheapest plane between bins that leaves at most `most` triangles on each side.
/// Returns nothing if no plane does so, for example because one bin holds all references.
std::optional<BinnedSahSplit> find_best_binned_sah_split(const SahSplitBins& bins,
                                                         std::size_t most);

/// The most references that `find_best_sah_split_by_sweep` accepts.
inline constexpr std::size_t kMaxSweepTriangles = 8;

/// The cheapest way to cut a list of references in two along an axis.
struct SweptSahSplit {
    double cost;        ///< sum over the sides of half area times count
    std::size_t middle; ///< index of the first reference on the right
};

/// Sorts references by centre, then by number, along the axis with the cheapest division, and
/// returns that division. Returns nothing if one side would always have more than `most`. Accepts
/// at most kMaxSweepTriangles references.
std::optional<SweptSahSplit> find_best_sah_split_by_sweep(TriangleReferences references,
                                                          std::size_t most);

/// Moves the half with the smaller centres, along the longest axis of their bounds, to the front.
/// Breaks ties by number. Returns the index of the first reference of the other half.
std::size_t partition_triangles_at_median(TriangleReferences references, const SimdBox& centres);

/// Keeps one reference for each set of equal triangles, the one with the lowest number. Returns
/// them in order of number. If more triangles share a centre than fit into a leaf, a ray would test
/// every copy: all are at the same t and the lowest number wins.
TriangleReferences remove_duplicate_triangles(TriangleReferences references,
                                              std::span<const Triangle> triangles,
                                              DuplicateTriangleSearchScope copies);

} // namespace catoptric::bvh
