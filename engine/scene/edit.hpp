#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

#include <variant>

/// Edits of a scene that is being shown. Indices refer to Scene::objects and Scene::materials.
namespace catoptric::scene {

/// New transform of an object at rest, from which its motion goes on. The object's exact sphere
/// moves along if the change is a similarity. Otherwise the object loses the sphere and is drawn as
/// its mesh.
struct Placing {
    std::size_t object = 0;
    dmat4 world_from_object{1};
};
/// Assignment of another of the scene's materials to one object.
struct Painting {
    std::size_t object = 0;
    std::size_t material = 0;
};
/// Replacement of a material, for all objects that have it. A material that emits makes them
/// lights.
struct Mixing {
    std::size_t material = 0;
    Material value;
};

using Edit = std::variant<Placing, Painting, Mixing>;

inline Edit move(std::size_t object, const dmat4& world_from_object) {
    return Placing{object, world_from_object};
}
inline Edit paint(std::size_t object, std::size_t material) { return Painting{object, material}; }
inline Edit set_material(std::size_t material, Material value) {
    return Mixing{material, std::move(value)};
}

/// Applies an edit. Throws `Failure::usage` for an index out of range, or for a transform that is
/// not finite, affine and invertible. The scene is then unchanged.
CATOPTRIC_API void apply(Scene& scene, const Edit& edit);

} // namespace catoptric::scene
