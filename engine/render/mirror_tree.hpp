#pragma once

#include "core/math.hpp"
#include "shared.h"

#include <span>
#include <vector>

namespace catoptric::render {

/// Largest number of mirrors that rays test one by one. For so few mirrors a tree would not be
/// faster.
inline constexpr std::size_t kMaxMirrorsWithoutTree = 8;

/// Returns a tree over the exact spheres or bounds of mirrors, which shaders walk without a stack
/// (shaders/lib/next_mirror.glsl). The tree has 2 n - 1 nodes for n mirrors, parents before
/// children, and two texels a node. The first texel holds the low corner and the node's mirror
/// number from 1, or 0. The second holds the high corner and the number of the node after the whole
/// subtree. Costs O(n log n).
std::vector<vec4> build_mirror_tree(std::span<const shared::Probe> probes);

} // namespace catoptric::render
