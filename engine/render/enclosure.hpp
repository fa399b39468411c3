#pragma once

#include "render/geometry.hpp"

namespace catoptric::render {

/// Returns whether the object's triangles form a closed surface with `place` (scene units) inside
/// or on it. Costs O(1) if `place` is outside the bounds, else O(n log n) in the object's
/// triangles.
bool encloses(const FrameGeometry& geometry, const DrawRange& range, const dvec3& place);

/// Returns whether the mesh is a closed surface around the middle of its bounds, with all triangles
/// clockwise as seen from that middle. A sphere is such a mesh. No back face is visible from
/// outside. Costs O(n log n) in the mesh's triangles.
bool is_closed_shell(const scene::Mesh& mesh);

} // namespace catoptric::render
