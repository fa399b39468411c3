#pragma once

#include "../core/export.hpp"
#include "texture.hpp"

#include <optional>

namespace catoptric::scene {

/// What a surface does with light: one model for raster and rays, evaluated where it is seen, with
/// the textures' values there. With c = albedo (times texture, times the vertices' colour), m =
/// metallic, a = roughness: diffuse c (1 - m); F0 = mix(dielectric_f0, c, m), F90 = mix(
/// dielectric_f90, 1, m). Where a <= Scene::mirror_max_roughness it is sharp: what it reflects is
/// R = F0 + (F90 - F0) (1 - cos)^5 (Schlick 1994) of what the mirrored ray sees, and (1 - R) of its
/// diffuse light; elsewhere it is Lambertian, the metal part too. With `mirror` R is `reflectance`,
/// whatever the angle.
struct Material {
    std::string name;
    vec3 albedo{0};          ///< base colour, linear, in [0,1]
    vec3 emission{0};        ///< radiance Ke
    bool mirror = false;     ///< reflects `reflectance` of all light, sharply, at any angle
    vec3 reflectance{1};     ///< of a mirror, in [0,1]
    bool two_sided = false;  ///< the normal turns to who looks; an open lamp shines both ways
    bool front_only = false; ///< not there from behind, for eyes and rays that see; mirrors are
    bool unlit = false;      ///< shows its albedo whatever the light (KHR_materials_unlit)

    float metallic = 0, roughness = 1;
    vec3 dielectric_f0{.04f};
    vec3 dielectric_f90{1};
    float alpha = 1;
    float alpha_cutoff = 0; ///< what has less alpha is not there; 0: everything is

    /// Of sRGB: base colour and alpha; emission. Linear: metallic in blue, roughness in green.
    std::optional<Texture> albedo_texture, emission_texture, roughness_texture;

    /// What its meshes light with, radiance. None: `emission`, where no texture varies it.
    std::optional<vec3> light;

    bool operator==(const Material&) const = default;
};

/// Whether the surface is only there from its front, for eyes and rays that see: `front_only`, or
/// a light that shines to one side. All but a light casts its shadow from both sides.
CATOPTRIC_API bool is_one_sided(const Material& material);
/// Whether it can be seen by its own light.
CATOPTRIC_API bool glows(const Material& material);
/// What it lights others with, radiance; 0: nothing.
CATOPTRIC_API vec3 light_of(const Material& material);
/// Whether some of it may be cut out.
CATOPTRIC_API bool is_masked(const Material& material);

} // namespace catoptric::scene
