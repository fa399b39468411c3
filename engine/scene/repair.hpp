#pragma once

#include "scene/scene.hpp"

#include <string>

namespace catoptric::scene {

// What every loader does with a mesh as the file gave it, so that it keeps Mesh's promises.

/// Throws `bad_data` naming `place` unless every index has its vertex, every number is finite and
/// there are as many normals as positions, or none.
void check_mesh(const Mesh& mesh, const std::string& place);

/// Drops triangles without area and vertices that nothing uses; normals become unit length; where a
/// normal is missing or has no direction, the triangle gets its own vertices with its geometric
/// normal. Returns the number of triangles dropped.
std::size_t repair(Mesh& mesh);

/// True for an emission that can be: each component finite and at least 0.
bool is_radiance(const vec3& emission);

/// Drops objects that have no triangle with an area, with a warning. Throws `bad_data` naming
/// `file` when no object is left, or when one reaches beyond what double precision holds.
void finish(Scene& scene, const std::string& file);

} // namespace catoptric::scene
