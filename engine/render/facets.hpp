#pragma once

#include "scene/scene.hpp"

namespace catoptric::render {

/// Returns whether the normal of some corner differs from its facet's plane normal, on either side,
/// by more than 6 degrees. Light on such meshes fades towards the plane of the facet
/// (`facet_light_share` in lib/math/light.glsl). Other meshes are lit by their normals alone,
/// and so receive light from up to 6 degrees below the plane. Angles are measured in the mesh's own
/// coordinates. Costs O(n).
bool normals_differ_from_facets(const scene::Mesh& mesh);

} // namespace catoptric::render
