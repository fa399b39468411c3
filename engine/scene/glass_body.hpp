#pragma once

#include "scene/scene.hpp"
#include "shared.h"

#include <optional>

namespace catoptric::scene {

/// A simple body that stands for a body of glass where rays are not traced through its mesh
/// (shaders/lib/refraction.glsl). Thin: rays are not bent. The values are those of Probe::kind.
enum class GlassBody : std::uint32_t {
    thin = shared::kMirrorThinGlass,
    sphere = shared::kMirrorGlassSphere,
    box = shared::kMirrorGlassBox
};

/// Returns the volume of a closed mesh in its own space; 0 for an open mesh. Costs O(n log n) in
/// triangles.
double compute_closed_volume(const Mesh& mesh);

/// Returns the simple body that comes closest to the object, or nothing if the object is no glass.
/// Decides by the share of its bounds in the world that it fills, and by how long these are: a ball
/// fills .52 of a cube, an upright pane all of its bounds, a bottle or an oblique pane little.
/// Sheets and open meshes are thin. `volume`: compute_closed_volume of its mesh. Costs O(vertices),
/// for the bounds.
std::optional<GlassBody> model_glass_body(const Scene& scene, const Object& object, double volume);

} // namespace catoptric::scene
