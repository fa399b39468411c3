#pragma once

#include "scene/scene.hpp"

// Finds surfaces whose reflections are blurred.
namespace catoptric::scene {

/// Returns whether some part of the object may reflect by a lobe: rougher than
/// shared::kMaxSharpRoughness,
/// and not above Scene::mirror_max_roughness, from which on surfaces are Lambertian. Of a textured
/// material, the whole range of the texture counts. A Material::mirror is never rough.
bool reflects_by_lobe(const Scene& scene, const Object& object);
/// Returns whether any object of the scene reflects by a lobe. Rays of such a scene are drawn at
/// random.
bool has_rough_reflector(const Scene& scene);
/// Returns whether a mirror, which a comparison judges, reflects by a lobe.
bool has_rough_mirror(const Scene& scene);

} // namespace catoptric::scene
