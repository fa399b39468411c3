#pragma once

#include "scene/scene.hpp"
#include "shared.h"

#include <optional>

namespace catoptric::scene {

/// The simple body that replaces the mesh of a glass object where rays are not traced through the
/// mesh (shaders/lib/refraction.glsl). With `thin`, rays are not bent. The values are those of
/// Probe::kind.
enum class GlassBody : std::uint32_t {
    thin = shared::kMirrorThinGlass,
    sphere = shared::kMirrorGlassSphere,
    box = shared::kMirrorGlassBox
};

/// Returns the volume of a closed mesh in its own space; 0 for an open mesh. Costs O(n log n) in
/// triangles.
double closed_volume(const Mesh& mesh);

/// Returns the simple body that is closest to a glass object, or nothing if the object is no glass.
/// The choice depends on the share of the object's bounds that the object fills, and on the sides
/// of the bounds. For example, a ball fills .52 of a cube, an upright pane all of its bounds, and a
/// bottle or an oblique pane little. Sheets and open meshes are thin. `volume`: closed_volume of
/// the object's mesh. Takes O(vertices), for the bounds.
std::optional<GlassBody> choose_glass_body(const Scene& scene, const Object& object, double volume);

} // namespace catoptric::scene
