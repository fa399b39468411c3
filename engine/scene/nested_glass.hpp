#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <set>

namespace catoptric::scene {

/// Returns the materials of solid bodies of glass that intersect or contain each other. Rays treat
/// each surface of such bodies as a surface between glass and air. Bodies are compared where the
/// scene places them at rest, and only if their bounds overlap. Of each body at most 16 vertices
/// are tested, so a small intersection may be missed. Bodies that only touch do not count. Costs
/// O(n log n) in triangles for bodies with overlapping bounds.
std::set<std::size_t> find_nested_glass_materials(const Scene& scene);

} // namespace catoptric::scene
