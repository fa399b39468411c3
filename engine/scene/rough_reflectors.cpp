#include "scene/rough_reflectors.hpp"

#include "scene/material_facts.hpp"
#include "shared.h"

#include <algorithm>

namespace catoptric::scene {

namespace {

/// Returns whether the material is rougher than a perfect mirror somewhere. The green channel of
/// the texture multiplies the roughness.
bool is_rough_somewhere(const Material& material) {
    if (!(material.roughness > shared::kMaxSharpRoughness)) return false;
    if (!material.roughness_texture) return true;
    return std::ranges::any_of(material.roughness_texture->image->texels, [&](std::uint32_t texel) {
        return static_cast<float>(texel >> 8 & 0xFFU) / 255 * material.roughness >
               shared::kMaxSharpRoughness;
    });
}

} // namespace

bool may_reflect_by_lobe(const Scene& scene, const Object& object) {
    const Material& material = scene.materials[object.material];
    const bool has_rough_coat = has_clear_coat(material) &&
                                material.clearcoat_roughness > shared::kMaxSharpRoughness;
    return has_rough_coat || ((is_glass(material) || has_specular(material)) && !material.unlit &&
                              is_rough_somewhere(material));
}

bool has_rough_reflector(const Scene& scene) {
    return std::ranges::any_of(
        scene.objects, [&](const Object& object) { return may_reflect_by_lobe(scene, object); });
}

} // namespace catoptric::scene
