#pragma once

#include "bvh/bvh.hpp"

namespace peers {

/// A tree as a list of boxes in the order of its walk, a texel each, that needs no stack.
struct SkipLinks {
    /// Node 0: how many there are with it, in w. The others: of each axis the planes in steps, low
    /// in bits 0 to 15 and high above; w of a leaf: 1 << 31 | triangles << 27 | the first one's
    /// place; of an inner node the node behind all below it, which is where a ray goes that misses.
    std::vector<catoptric::vec4> nodes;
    catoptric::vec3 lowest{0}; ///< where planes are 0
    float steps = 0;           ///< a scene unit
};

/// Boxes grow by up to two steps of 65535 a side. A tree whose root is a leaf has no nodes.
SkipLinks skip_links(const catoptric::bvh::Bvh& tree);

} // namespace peers
