#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

#include <variant>

/// Edits of a scene that is being shown. Indices refer to Scene::objects and Scene::materials.
namespace catoptric::scene {

/// Edit that sets the transform of an object at rest. The object's motion continues from there. The
/// object's exact sphere moves along if the change is a similarity. Otherwise the object loses the
/// sphere and is drawn as its mesh.
struct Placing {
    std::size_t object = 0;
    dmat4 world_from_object{1};
};
/// Edit that gives one object another material of the scene.
struct Painting {
    std::size_t object = 0;
    std::size_t material = 0;
};
/// Edit that replaces a material of the scene, for all objects with this material. If the new
/// material emits light, these objects become lamps.
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
