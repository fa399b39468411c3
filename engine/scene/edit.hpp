#pragma once

#include "../core/export.hpp"
#include "scene.hpp"

#include <variant>

/// Changes of a scene that is being shown. Indices into Scene::objects and Scene::materials.
namespace catoptric::scene {

/// Another place at rest; motion goes on from there. An exact sphere goes along where the change is
/// a similarity, else the object is its mesh from then on.
struct Placing {
    std::size_t object = 0;
    dmat4 world_from_object{1};
};
/// Another of the scene's materials for one object.
struct Painting {
    std::size_t object = 0;
    std::size_t material = 0;
};
/// Another material for all objects that have this one; one that emits makes them lights.
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

/// Throws `Failure::usage` naming an index that is not there or a transform that is no place, and
/// then leaves the scene as it was.
CATOPTRIC_API void apply(Scene& scene, const Edit& edit);

} // namespace catoptric::scene
