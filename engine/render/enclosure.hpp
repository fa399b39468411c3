#pragma once

#include "render/geometry.hpp"

namespace catoptric::render {

/// Whether the object's triangles are a closed surface with the place (scene units) in it or on it.
/// Costs a look at the bounds where it is outside of them, else O(n log n) in the object's
/// triangles.
bool encloses(const Geometry& geometry, const DrawRange& range, const dvec3& place);

/// Whether the mesh is a closed surface around the middle of its bounds whose triangles, seen from
/// there, all run clockwise, as those of a ball do: from outside none that faces away is seen.
/// O(n log n) in its triangles.
bool is_shell(const scene::Mesh& mesh);

} // namespace catoptric::render
