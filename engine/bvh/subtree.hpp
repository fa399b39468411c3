#pragma once

#include "bvh/split.hpp"

/// Function that builds a subtree on one thread.
namespace catoptric::bvh {

/// The references of a tree and the memory for its triangles, both in the order of the leaves. A
/// split moves a part from one buffer to the other.
struct BuildWorkspace {
    std::span<const Triangle> input;
    std::array<TriangleReferences, 2> buffers;
    vec4* triangles;    ///< Bvh::triangles, with room for all triangles
    std::uint32_t most; ///< the most triangles in a leaf
    CopyScope copies;

    TriangleReferences references(const ReferenceRange& part) const {
        return buffers[part.in_second ? 1 : 0].subspan(part.first, part.count);
    }
    /// Returns the place in the other buffer that the two sides of the part will fill.
    TriangleReferences scratch(const ReferenceRange& part) const {
        return buffers[part.in_second ? 0 : 1].subspan(part.first, part.count);
    }
};

/// Returns how many triangles fit into a subtree with `depth` inner nodes above it.
inline std::size_t max_triangles_below(const BuildWorkspace& work, std::uint32_t depth) {
    return std::size_t{work.most} << (kMaxTreeDepth - depth);
}

struct Subtree {
    std::vector<vec4> nodes;   ///< words of inner nodes count nodes from 1
    std::size_t triangles = 0; ///< stored from the part's first place on
    std::uint32_t root = f32::kBvhEmptyChild;
};

/// Builds the subtree of a part with `depth` inner nodes above it. Costs O(n log^2 n).
Subtree build_subtree(const BuildWorkspace& work, const ReferenceRange& part, std::uint32_t depth);

} // namespace catoptric::bvh
