#pragma once

#include "scene/material.hpp"
#include "shared.h"

#include <string_view>

// Lists of the members of a material, and functions that derive properties from them.
namespace catoptric::scene {

/// A number that scales a property of a material. glTF reading and writing, `info`, hashes and the
/// device's MaterialParameters follow from the rows of MATERIAL_FACTORS (shaders/shared.h).
struct MaterialFactor {
    std::string_view name;
    float Material::*member;
    std::string_view extension; ///< glTF extension, or kCoreFactors
    std::string_view key;       ///< name of the value in the extension's JSON object
    float gltf_default;         ///< value without this key
    float largest;              ///< values range from 0 to this
};
/// The part of a glTF material that holds the factors of glTF itself.
inline constexpr std::string_view kCoreFactors = "pbrMetallicRoughness";
inline constexpr MaterialFactor kMaterialFactors[] = {
#define MAKE_FACTOR(name, extension, key, gltf_default, largest)                                   \
    {#name, &Material::name, #extension, #key, gltf_default, largest},
    MATERIAL_FACTORS(MAKE_FACTOR)
#undef MAKE_FACTOR
};

/// Reflectance of glass and plastic seen head-on: that of the index of refraction 1.5, which glTF
/// takes for dielectrics. At grazing angle the reflectance is 1.
inline constexpr float kUsualDielectricF0 = .04f;

/// Calls `visit` with each member of a material. Hashes follow from the order of the calls. A
/// member that is missing here and in FURTHER_MATERIAL_FACTORS does not compile.
template <typename Visit>
inline void visit_material_members(const Material& material, Visit&& visit) {
#define NAME_FACTOR(name, extension, key, gltf_default, largest) name,
#define VISIT_FACTOR(name, extension, key, gltf_default, largest) visit(name);
    const auto& [name, albedo, emission, mirror, reflectance, two_sided, front_only, unlit,
                 metallic, roughness, clearcoat, clearcoat_roughness, dielectric_f0, dielectric_f90,
                 transmission, ior, dispersion, FURTHER_MATERIAL_FACTORS(NAME_FACTOR) solid,
                 absorption, alpha, alpha_cutoff, blended, albedo_texture, emission_texture,
                 roughness_texture, normal_texture, normal_scale, light] = material;
    visit(name), visit(albedo), visit(emission), visit(mirror), visit(reflectance);
    visit(two_sided), visit(front_only), visit(unlit), visit(metallic), visit(roughness);
    visit(clearcoat), visit(clearcoat_roughness), visit(dielectric_f0), visit(dielectric_f90);
    visit(transmission), visit(ior), visit(dispersion), visit(solid);
    visit(absorption), visit(alpha), visit(alpha_cutoff), visit(blended);
    visit(albedo_texture), visit(emission_texture), visit(roughness_texture);
    visit(normal_texture), visit(normal_scale), visit(light);
    FURTHER_MATERIAL_FACTORS(VISIT_FACTOR)
#undef NAME_FACTOR
#undef VISIT_FACTOR
}

/// Returns whether camera and reflected rays see the surface only from its front. This holds for
/// `front_only` and for a light that shines to one side. All surfaces but lights cast their shadow
/// from both sides.
bool is_one_sided(const Material& material);
/// Returns whether the surface has a specular part, sharp or rough: it is no Lambertian surface.
/// False for `mirror`, whose reflectance is another member.
bool has_specular(const Material& material);
/// Returns whether rays pass through the surface: it transmits at least half of the light and has
/// no metal. Glass casts no shadow unless Scene::tints_glass_shadows is set.
bool is_glass(const Material& material);
/// Glass, unlit surfaces and materials with `mirror` have no clear coat.
bool has_clear_coat(const Material& material);
/// Returns F0 of a dielectric with this finite index of refraction in air (Fresnel's equations).
inline double f0_from_ior(double ior) {
    const double root = (ior - 1) / (ior + 1);
    return root * root;
}
/// Returns whether the surface can be seen by its own light.
bool is_visibly_emissive(const Material& material);
/// Returns the radiance with which the surface lights others; 0 if it lights nothing.
vec3 emitted_radiance(const Material& material);
bool has_alpha_mask(const Material& material);

} // namespace catoptric::scene
