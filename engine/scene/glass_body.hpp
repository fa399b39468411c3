#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace catoptric::scene {

/// A simple body that stands for a body of glass where rays are not traced through its mesh
/// (shaders/lib/refraction.glsl). Thin: rays are not bent.
enum class GlassBody { thin, sphere, box };

/// Returns the simple body that comes closest to the object, or nothing if the object is no glass.
/// Decides by the share of its bounds in the world that it fills, and by how long these are: a ball
/// fills .52 of a cube, an upright pane all of its bounds, a bottle or an oblique pane little.
/// Sheets and open meshes are thin. Costs O(triangles).
std::optional<GlassBody> model_glass_body(const Scene& scene, const Object& object);

} // namespace catoptric::scene
