#pragma once

#include "render/geometry.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::render {

/// Of each object, 1 where its shadow by a light falls on nothing: all there is stands before each
/// of its triangles' planes, or in it, as the walls, the floor and the ceiling of a room that the
/// light is in. A shadow map need not show it: a receiver in the plane of its caster is lifted off
/// it. Asked of objects of few triangles in scene units; the others, and all after some millions of
/// comparisons, are 0. By bounds, and by vertices where these do not tell.
std::vector<std::uint8_t> find_backdrops(const Geometry& geometry, const shared::Light& light);

} // namespace catoptric::render
