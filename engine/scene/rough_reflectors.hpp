#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// Returns whether some part of the object may reflect by a lobe: it is rougher than
/// shared::kMaxSharpRoughness and not Lambertian. Of a textured material, the whole range of the
/// texture counts. A Material::mirror is never rough.
bool may_reflect_by_lobe(const Scene& scene, const Object& object);
/// Rays of a scene with a rough reflector are drawn at random.
bool has_rough_reflector(const Scene& scene);

} // namespace catoptric::scene
