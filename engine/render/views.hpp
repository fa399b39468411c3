#pragma once

#include "render/geometry.hpp"

#include <array>

namespace catoptric::render {

/// The camera's projection onto a picture of `size` pixels; `gap` = distance to the nearest thing.
/// An orthographic one looks from its eye, or from where `everything` begins in front of that, to
/// its end.
shared::View camera_view(const scene::Camera& camera, const Space& space, uvec2 size, float gap,
                         const Bounds<float>& everything = {});

/// What the objects of the geometry take up.
Bounds<float> bounds_of(const Geometry& geometry);

/// Six 90-degree views from a point along the world's axes, in the order and orientation of cube
/// map faces (+X -X +Y -Y +Z -Z): what is drawn with them can be sampled with a world direction.
std::vector<shared::View> cube_views(vec3 eye, float gap);

/// The same, turned so that face +Z looks along `forward` (unit; zero: world axes).
std::vector<shared::View> turned_cube_views(vec3 eye, vec3 forward, float gap);
/// Turned by this matrix.
std::vector<shared::View> turned_cube_views(vec3 eye, const glm::mat3& world_from_cube, float gap);

/// Two parallel views along `forward` (unit) from one eye before everything, down to its end: one
/// over `core`, and one over everything; the same twice where that is hardly larger.
std::array<shared::View, 2> sun_views(vec3 forward, const Bounds<float>& core,
                                      const Bounds<float>& everything);

/// False when the box is certainly outside the view: all corners beyond one of its planes.
bool may_meet(const shared::View& view, const Bounds<float>& box);
/// The same of an object, whose bounding sphere may be outside though its box is not.
bool may_meet(const shared::View& view, const DrawRange& range);

} // namespace catoptric::render
