#include "scene/material.hpp"

#include "scene/material_facts.hpp"

namespace catoptric::scene {

bool is_one_sided(const Material& material) {
    if (material.mirror || material.two_sided) return false;
    return material.front_only || emitted_radiance(material) != vec3(0);
}

bool has_specular(const Material& material) {
    return !material.mirror && (material.metallic > 0 || material.dielectric_f0 != vec3(0) ||
                                material.dielectric_f90 != vec3(0));
}

bool is_glass(const Material& material) {
    constexpr float kMinGlassTransmission = .5f;
    return material.transmission >= kMinGlassTransmission && material.metallic == 0 &&
           !material.mirror && !material.unlit;
}

bool has_clear_coat(const Material& material) {
    return material.clearcoat > 0 && !material.mirror && !material.unlit && !is_glass(material);
}

bool is_visibly_emissive(const Material& material) { return material.emission != vec3(0); }

vec3 emitted_radiance(const Material& material) {
    return material.light.value_or(material.emission_texture ? vec3(0) : material.emission);
}

bool has_alpha_mask(const Material& material) {
    return material.blended || material.alpha_cutoff > 0;
}

} // namespace catoptric::scene
