#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <vector>

namespace catoptric::scene {

/// Returns for each triangle the index of its light; nothing for a triangle without area. The index
/// counts the lights that `lights` makes of this mesh alone, from 0.
std::vector<std::optional<std::size_t>> light_of_triangles(const Mesh& mesh,
                                                           const dmat4& world_from_object);

} // namespace catoptric::scene
