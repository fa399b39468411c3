#pragma once

#include "scene/notes.hpp"
#include "scene/scene.hpp"

#include <string>

namespace catoptric::scene {

// What every loader does with a mesh as the file gave it, so that it keeps Mesh's promises. Its
// indices have their vertices and its numbers are finite.

/// Drops triangles without area and vertices that nothing uses; normals become unit length; where a
/// normal is missing or has no direction, the triangle gets its own vertices with its geometric
/// normal. Returns the number of triangles dropped.
std::size_t repair(Mesh& mesh);

/// How many vertices `repair` may add: corners whose normal, one for each position, has no
/// direction.
std::size_t corners_without_normal(const Mesh& mesh);

/// True for an emission that can be: each component finite and at least 0.
bool is_radiance(const vec3& emission);

/// Drops objects that have no triangle with an area; turns notes into the scene's warnings,
/// gaps into its gaps. Throws `bad_data` naming `file` when no object is left, or when one reaches
/// beyond what double precision holds.
void finish(Scene& scene, const std::string& file, Notes& notes,
            std::vector<UnsupportedFeature> unsupported = {});

} // namespace catoptric::scene
