#pragma once

#include "bvh/subtree.hpp"

/// Building a tree on several threads: the top of the tree level by level, and each small subtree
/// as one task. Neither the work nor the tree depends on the number of threads.
namespace catoptric::bvh {

/// Builds the tree over one or two parts, whose references fill the first buffer in this order, and
/// appends it to the header in `nodes`. Two parts become the two children of the root. Returns the
/// number of triangles kept. The kept triangles are the first elements of `work.triangles`.
std::size_t build_in_parallel(const BuildWorkspace& work, std::span<const ReferenceRange> parts,
                              unsigned threads, std::vector<vec4>& nodes);

} // namespace catoptric::bvh
