#pragma once

#include "scene.hpp"

#include <variant>

/// Functions that build scenes in code, and edits of a scene that is being shown. Indices refer to
/// Scene::objects and Scene::materials.
namespace catoptric::scene {

/// Returns the index in Scene::materials.
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

/// Returns two triangles, (a b c) and (a c d), with the flat normal normalize(cross(b-a, c-a)).
CATOPTRIC_API Mesh quad(std::string name, dvec3 a, dvec3 b, dvec3 c, dvec3 d);
/// Returns the box [lo, hi] seen from outside, with flat normals. Each side shows texture space
/// [0,1]^2.
CATOPTRIC_API Mesh box(std::string name, dvec3 lo, dvec3 hi);
/// Returns the surface of a profile of (radius, height) that turns around the y axis, with `around`
/// vertices to a turn. The outside lies to the right of a profile that goes upwards. Normals are
/// those of the curve through the points. A point that is given twice makes a sharp corner. u goes
/// once around, v along the profile's length.
CATOPTRIC_API Mesh lathe(std::string name, const std::vector<dvec2>& profile, int around);
/// Returns a ring around the y axis with smooth normals, `around` vertices along it, half as many
/// across.
CATOPTRIC_API Mesh torus(std::string name, double radius, double thickness, int around);
/// Returns a unit ball: a tetrahedron subdivided `levels` times, with midpoints normalised at each
/// level. It has 4^(levels+1) triangles, 2*4^levels + 2 shared vertices and smooth normals. Level 5
/// is a ball of `cornell-mirrors`: 4096 triangles, 2050 vertices.
CATOPTRIC_API Mesh ball(std::string name, int levels);

/// Edit that sets the transform of an object at rest. The object's motion continues from there; an
/// object that follows a node of a rig stays with the node. The object's exact sphere moves along
/// if the change is a similarity. Otherwise the object loses the sphere and is drawn as its mesh.
struct PlacementEdit {
    std::size_t object = 0;
    dmat4 world_from_object{1};
};
/// Edit that gives one object another material of the scene.
struct ObjectMaterialEdit {
    std::size_t object = 0;
    std::size_t material = 0;
};
/// Edit that replaces a material of the scene, for all objects with this material. If the new
/// material emits light, these objects become lamps.
struct MaterialEdit {
    std::size_t material = 0;
    Material value;
};

/// Later objects and mirrors move up by one. History is discarded.
struct RemovalEdit {
    std::size_t object = 0;
};

using Edit = std::variant<PlacementEdit, ObjectMaterialEdit, MaterialEdit, RemovalEdit>;

inline Edit move(std::size_t object, const dmat4& world_from_object) {
    return PlacementEdit{object, world_from_object};
}
inline Edit paint(std::size_t object, std::size_t material) {
    return ObjectMaterialEdit{object, material};
}
inline Edit set_material(std::size_t material, Material value) {
    return MaterialEdit{material, std::move(value)};
}
inline Edit remove(std::size_t object) { return RemovalEdit{object}; }

/// Throws `Failure::usage` for an index out of range or a transform that is not finite, affine and
/// invertible, and as check_scene for a material; the scene is then unchanged.
CATOPTRIC_API void apply_edit(Scene& scene, const Edit& edit);

} // namespace catoptric::scene
