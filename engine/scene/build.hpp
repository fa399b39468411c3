#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

/// Functions that build scenes in code.
namespace catoptric::scene {

/// Appends a material to Scene::materials. Returns its index.
CATOPTRIC_API std::size_t add_material(Scene& scene, Material material);

/// Appends the mesh and an object that shows it, named after the mesh.
CATOPTRIC_API void add_mesh(Scene& scene, Mesh mesh, std::size_t material);

/// Adds an object of two triangles, (a b c) and (a c d).
CATOPTRIC_API void add_quad(Scene& scene, const std::string& name, std::size_t material, dvec3 a,
                            dvec3 b, dvec3 c, dvec3 d);

/// Adds an exact sphere: an object with a mesh of 4^(levels+1) triangles, and with the sphere that
/// the mesh approximates.
CATOPTRIC_API void add_ball(Scene& scene, const std::string& name, std::size_t material,
                            dvec3 centre, double radius, int levels = 3);

} // namespace catoptric::scene
