#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <vector>

namespace catoptric::scene {

/// Which of the lights that `lights` makes of a mesh alone each triangle belongs to, counted from
/// the mesh's first; none of a triangle without area.
std::vector<std::optional<std::size_t>> light_of_triangles(const Mesh& mesh,
                                                           const dmat4& world_from_object);

} // namespace catoptric::scene
