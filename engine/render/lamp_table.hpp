#pragma once

#include "render/geometry.hpp"

#include <span>
#include <vector>

namespace catoptric::render {

/// Most triangles of lamps among which points are drawn. Shaders draw triangle and point with one
/// random number of 24 bits.
inline constexpr std::size_t kMaxLampTriangles = 1 << 16;

/// Returns the list with which shaders draw points on lamps (shaders/lib/lamps.glsl), in scene
/// units: the triangles of all objects whose emission, without textures, is not black. Returns an
/// empty list if there are no such triangles, or more than kMaxLampTriangles. `surfaces`: by
/// object. Costs O(n) in the triangles of lamps.
std::vector<vec4> make_lamp_table(const FrameGeometry& geometry,
                                  std::span<const shared::Surface> surfaces);

} // namespace catoptric::render
