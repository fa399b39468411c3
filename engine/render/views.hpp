#pragma once

#include "render/geometry.hpp"

namespace catoptric::render {

/// The camera's projection onto a picture of `size` pixels; `gap` = distance to the nearest thing.
shared::View camera_view(const scene::Camera& camera, const Space& space, uvec2 size, float gap);

/// Six 90-degree views from a point along the world's axes, in the order and orientation of cube
/// map faces (+X -X +Y -Y +Z -Z): what is drawn with them can be sampled with a world direction.
std::vector<shared::View> cube_views(vec3 eye, float gap);

/// The same, turned so that face +Z looks along `forward` (unit; zero: world axes).
std::vector<shared::View> turned_cube_views(vec3 eye, vec3 forward, float gap);

/// False when the box is certainly outside the view: all corners beyond one of its planes.
bool may_meet(const shared::View& view, const Bounds<float>& box);

} // namespace catoptric::render
