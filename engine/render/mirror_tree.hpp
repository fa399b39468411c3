#pragma once

#include "core/math.hpp"
#include "shared.h"

#include <span>
#include <vector>

namespace catoptric::render {

/// As many mirrors are looked through one by one: a walk over a tree of theirs costs as much.
inline constexpr std::size_t kFewMirrors = 8;

/// A tree over what rays may meet of mirrors, exact spheres or bounds, as shaders walk it without a
/// stack (shaders/lib/next_mirror.glsl): two texels a node, parents before their children; 2 n - 1
/// nodes for n mirrors. A low corner and the number of the node's mirror from 1, or 0; a high
/// corner and the number of the node after all that is below it. O(n log n).
std::vector<vec4> mirror_tree(std::span<const shared::Probe> probes);

} // namespace catoptric::render
