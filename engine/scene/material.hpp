#pragma once

#include "../core/export.hpp"
#include "texture.hpp"

#include <optional>

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
    vec3 reflectance{1};     ///< of a mirror, in [0,1]
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
