#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::scene {

inline constexpr std::uint32_t kMaxGlassRank = 16;

/// Returns a rank for each object: 0, unless the object is a solid body of glass that shares space
/// with another. Where two such bodies are, rays find the one of higher rank (Schmidt and Budge,
/// "Simple Nested Dielectrics in Ray Traced Images", 2002). Of two bodies one of which is inside
/// the other, that is the inner one. Of others it is the one with the higher index of refraction,
/// such as a glass whose wall the water in it overlaps; of equal ones the first in the scene.
/// Bodies are compared where the scene places them, and only if their bounds overlap. Of each body
/// at most 16 vertices are tested, so a small intersection may be missed. Bodies that only touch do
/// not count. Costs O(n log n) in triangles for bodies with overlapping bounds.
std::vector<std::uint32_t> rank_nested_glass(const Scene& scene);

} // namespace catoptric::scene
