#pragma once

#include "../core/export.hpp"
#include "texture.hpp"

#include <optional>
#include <string_view>

namespace catoptric::scene {

/// Optical model of a surface, the same for raster and rays. It is evaluated at the visible point,
/// with the textures' values there. Let c = albedo (times texture, times the vertices' colour), m =
/// metallic and a = roughness.
/// The diffuse colour is c (1 - m). F0 = mix(dielectric_f0, c, m), and F90 = mix(dielectric_f90, 1,
/// m). The surface is sharp where a <= Scene::mirror_max_roughness. A sharp surface shows R times
/// what the mirrored ray sees, plus (1 - R) times its diffuse light. Here R = F0 + (F90 - F0) (1 -
/// cos)^5 (Schlick 1994). Elsewhere the surface is Lambertian, including its metal part. With
/// `mirror`, R is `reflectance` at every angle.
struct Material {
    std::string name;
    vec3 albedo{0};          ///< base colour, linear, in [0,1]
    vec3 emission{0};        ///< emitted radiance (Ke)
    bool mirror = false;     ///< reflects `reflectance` of all light, sharply, at any angle
    vec3 reflectance{1};     ///< reflectance of a mirror, each channel in [0,1]
    bool two_sided = false;  ///< the normal turns to the viewer; an open lamp shines both ways
    bool front_only = false; ///< back invisible to camera and reflected rays; not for mirrors
    bool unlit = false;      ///< shows its albedo in any light (KHR_materials_unlit)

    float metallic = 0, roughness = 1;
    vec3 dielectric_f0{.04f};
    vec3 dielectric_f90{1};
    float alpha = 1;
    float alpha_cutoff = 0; ///< parts with less alpha are cut out; 0: none are

    /// `albedo_texture` holds base colour and alpha. It and `emission_texture` are sRGB.
    /// `roughness_texture` is linear: metallic in blue, roughness in green.
    std::optional<Texture> albedo_texture, emission_texture, roughness_texture;

    /// Radiance with which its meshes light the scene. None: `emission`, or no light if a texture
    /// varies the emission.
    std::optional<vec3> light;

    bool operator==(const Material&) const = default;
};

/// A number from 0 to 1 that scales a property of a material. glTF reading and writing, `info` and
/// the device's MaterialParameters (shaders/shared.h) follow from the rows of kMaterialFactors.
struct MaterialFactor {
    std::string_view name; ///< as in MATERIAL_FACTORS of shaders/shared.h
    float Material::*member;
    std::string_view extension; ///< glTF extension, or kCoreFactors
    std::string_view key;       ///< member of that extension
    float gltf_default;         ///< value without this key
};
/// The part of a glTF material that holds the factors of glTF itself.
inline constexpr std::string_view kCoreFactors = "pbrMetallicRoughness";
inline constexpr MaterialFactor kMaterialFactors[] = {
    {"metallic", &Material::metallic, kCoreFactors, "metallicFactor", 1},
    {"roughness", &Material::roughness, kCoreFactors, "roughnessFactor", 1},
};

/// Calls `visit` with each member of a material, in the order of declaration. Hashes follow from
/// this list; a member that is missing here does not compile.
template <typename Visit>
inline void visit_members(const Material& material, Visit&& visit) {
    const auto& [name, albedo, emission, mirror, reflectance, two_sided, front_only, unlit,
                 metallic, roughness, dielectric_f0, dielectric_f90, alpha, alpha_cutoff,
                 albedo_texture, emission_texture, roughness_texture, light] = material;
    visit(name), visit(albedo), visit(emission), visit(mirror), visit(reflectance);
    visit(two_sided), visit(front_only), visit(unlit), visit(metallic), visit(roughness);
    visit(dielectric_f0), visit(dielectric_f90), visit(alpha), visit(alpha_cutoff);
    visit(albedo_texture), visit(emission_texture), visit(roughness_texture), visit(light);
}

/// Returns whether camera and reflected rays see the surface only from its front. This holds for
/// `front_only` and for a light that shines to one side. All surfaces but lights cast their shadow
/// from both sides.
CATOPTRIC_API bool is_one_sided(const Material& material);
/// Returns whether the surface can be seen by its own light.
CATOPTRIC_API bool glows(const Material& material);
/// Returns the radiance with which the surface lights others; 0 if it lights nothing.
CATOPTRIC_API vec3 light_of(const Material& material);
/// Returns whether an alpha mask may cut out parts of the surface.
CATOPTRIC_API bool is_masked(const Material& material);

} // namespace catoptric::scene
