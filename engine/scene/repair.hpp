#pragma once

#include "scene/notes.hpp"
#include "scene/scene.hpp"

#include <string>

namespace catoptric::scene {

// Repairs that every loader makes to a mesh from a file, so that the mesh keeps the promises of
// Mesh. The mesh passed in has indices within its vertices and finite numbers.

/// Drops triangles without area and vertices that no triangle uses. Normals become unit length.
/// Where a normal is missing or has no direction, the corner gets a vertex of its own with the
/// triangle's geometric normal. Returns the number of triangles dropped.
std::size_t repair_mesh(Mesh& mesh);

/// Returns how many vertices `repair_mesh` may add: the number of corners whose normal has no
/// direction. The mesh has one normal for each position.
std::size_t count_missing_normals(const Mesh& mesh);

/// Returns whether each component is finite and at least 0.
bool is_valid_radiance(const vec3& emission);

/// Drops objects that have no triangle with an area, or that lie too far out
/// (remove_distant_objects). Turns `notes` into the scene's warnings and `unsupported` into its
/// unsupported features. Throws `bad_data`, naming `file`, if no object is left or if coordinates
/// exceed 1e150.
void finish_scene(Scene& scene, const std::string& file, LoaderNotes& notes,
                  std::vector<UnsupportedFeature> unsupported = {});

} // namespace catoptric::scene
