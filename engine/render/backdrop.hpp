#pragma once

#include "render/geometry.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::render {

/// Finds the objects whose shadow falls on nothing for a given light. The result has an entry per
/// object: 1 for such an object, else 0. All geometry lies in front of each of the object's
/// triangles, or in the triangle's plane, on the light's side. Examples are the walls, floor and
/// ceiling of a room that contains the light. A shadow map need not show these objects, because a
/// receiver in the plane of its caster is moved off that plane.
///
/// Tests only objects of few triangles in scene units. Every other object gets 0, and so does every
/// object after some millions of comparisons. Compares bounds first, and vertices where the bounds
/// do not decide.
std::vector<std::uint8_t> find_backdrops(const FrameGeometry& geometry, const shared::Light& light);

} // namespace catoptric::render
