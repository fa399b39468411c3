#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

/// Scenes put together in code.
namespace catoptric::scene {

/// Index of a new material.
CATOPTRIC_API std::size_t add_material(Scene& scene, Material material);

/// An object of this mesh alone, with the mesh's name.
CATOPTRIC_API void add_mesh(Scene& scene, Mesh mesh, std::size_t material);

/// Two triangles (a b c) (a c d).
CATOPTRIC_API void add_quad(Scene& scene, const std::string& name, std::size_t material, dvec3 a,
                            dvec3 b, dvec3 c, dvec3 d);

/// A ball of 4^(levels+1) triangles that stands for an exact sphere.
CATOPTRIC_API void add_ball(Scene& scene, const std::string& name, std::size_t material,
                            dvec3 centre, double radius, int levels = 3);

} // namespace catoptric::scene
