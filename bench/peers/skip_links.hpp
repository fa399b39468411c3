#pragma once

#include "bvh/bvh.hpp"

namespace peers {

/// A bounding volume hierarchy as a list of nodes in the order of the walk, one texel for each
/// node. A walk of this list needs no stack.
struct SkipLinkBvh {
    /// Node 0 holds the number of nodes, itself included, in w. Each other node holds its box in
    /// x, y and z: the low plane, counted in steps, in bits 0 to 15, and the high plane in bits 16
    /// to 31. The word w of a leaf is 1 << 31 | number of triangles << 27 | place of the first
    /// triangle. The word w of an inner node is the skip link: the number of the node behind
    /// its subtree. A ray that misses the box continues there.
    std::vector<catoptric::vec4> nodes;
    catoptric::vec3 lowest{0}; ///< position of the planes with number 0
    float steps = 0;           ///< steps per scene unit
};

/// Converts a tree to skip links. Rounding widens a box by up to two steps on each side, where the
/// scene's longest side has 65535 steps. A tree whose root is a leaf gets no nodes.
SkipLinkBvh convert_bvh_to_skip_links(const catoptric::bvh::Bvh& tree);

} // namespace peers
