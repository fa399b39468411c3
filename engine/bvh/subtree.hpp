#pragma once

#include "bvh/split.hpp"

/// A subtree, built on one thread.
namespace catoptric::bvh {

/// The references of a tree and where their triangles go, both in the order of the leaves. A part
/// is divided from one buffer into the other.
struct Workspace {
    std::span<const Triangle> input;
    std::array<References, 2> buffers;
    vec4* triangles;    ///< Bvh::triangles, with room for all
    std::uint32_t most; ///< in a leaf
    Copies copies;

    References of(const Part& part) const {
        return buffers[part.in_second ? 1 : 0].subspan(part.first, part.count);
    }
    /// Where its sides go.
    References other(const Part& part) const {
        return buffers[part.in_second ? 0 : 1].subspan(part.first, part.count);
    }
};

/// Number of triangles that a subtree can hold of which `depth` inner nodes are above.
inline std::size_t capacity(const Workspace& work, std::uint32_t depth) {
    return std::size_t{work.most} << (kMaxDepth - depth);
}

/// What became of a part.
struct Subtree {
    std::vector<vec4> nodes;   ///< words of inner ones call the first 1
    std::size_t triangles = 0; ///< from the part's first place on
    std::uint32_t root = f32::kBvhNothing;
};

/// A part with `depth` inner nodes above it. Costs O(n log^2 n).
Subtree build_subtree(const Workspace& work, const Part& part, std::uint32_t depth);

} // namespace catoptric::bvh
