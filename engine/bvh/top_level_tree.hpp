#pragma once

#include "bvh/subtree.hpp"

/// A tree, built on several threads: its top level by level, what is small one subtree at a time.
/// What is done does not depend on their number, so that the tree does not either.
namespace catoptric::bvh {

/// Appends the tree over `root`, in the first buffer, to the header in `nodes`. Returns how many of
/// its triangles are left, which are the first of `work.triangles`.
std::size_t build_tree(const Workspace& work, const Part& root, unsigned threads,
                       std::vector<vec4>& nodes);

} // namespace catoptric::bvh
