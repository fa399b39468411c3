#pragma once

#include "scene/scene.hpp"

namespace catoptric::render {

/// Whether some corner's normal leaves that of its facet, on either side, by more than 6 degrees.
/// What light meets there fades towards the facet's plane (`facet_share` in lib/math/light.glsl);
/// everything else is lit by its normals alone, so from up to 6 degrees below a facet's plane. In
/// the mesh's own space. O(n).
bool leaves_facets(const scene::Mesh& mesh);

} // namespace catoptric::render
