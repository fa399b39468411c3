#pragma once

#include "render/geometry.hpp"

#include <array>

namespace catoptric::render {

/// Returns the camera's projection onto a picture of `size` pixels. `gap`: distance to the nearest
/// surface. An orthographic view starts at the eye, or where `everything` begins if that lies in
/// front of the eye, and ends where `everything` ends.
shared::View make_camera_view(const scene::Camera& camera, const SceneUnits& space, uvec2 size,
                              float gap, const Bounds<float>& everything = {});

Bounds<float> geometry_bounds(const FrameGeometry& geometry);

/// Returns six 90-degree views from a point along the world's axes. Their order and orientation are
/// those of cube map faces (+X -X +Y -Y +Z -Z). A cube drawn with them can be sampled with a world
/// direction.
std::vector<shared::View> make_cube_views(vec3 eye, float gap);

/// Returns make_cube_views, turned so that face +Z looks along `forward` (unit length; zero: world
/// axes).
std::vector<shared::View> make_turned_views(vec3 eye, vec3 forward, float gap);
/// Returns make_cube_views, turned by this matrix.
std::vector<shared::View> make_turned_views(vec3 eye, const glm::mat3& world_from_cube, float gap);

/// Returns two parallel views along `forward` (unit length). Both views start at one eye in front
/// of the whole scene and reach to the scene's far end. The first view covers the bounds `core`,
/// the second the bounds `everything`. The second view is returned twice if it is hardly larger
/// than the first.
std::array<shared::View, 2> make_directional_views(vec3 forward, const Bounds<float>& core,
                                                   const Bounds<float>& everything);

/// Returns false only if the box is certainly outside the view: all corners beyond one of its
/// planes.
bool may_show(const shared::View& view, const Bounds<float>& box);
/// Returns the same for an object. Also tests its bounding sphere, which may be outside although
/// the box is not.
bool may_show(const shared::View& view, const DrawRange& range);

} // namespace catoptric::render
