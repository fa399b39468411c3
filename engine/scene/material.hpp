#pragma once

#include "../core/math.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::scene {

/// Decoded picture, 8 bits a channel as in the file, red in the low byte. Row-major from the top.
struct Image {
    std::string name;
    uvec2 size{0};
    std::vector<std::uint32_t> texels; ///< size.x * size.y
    bool is_clamped = false;           ///< its file holds light above 1, which is clamped
};

/// How a surface reads an image: texel (i, j) is at ((i + .5) / width, (j + .5) / height), v down.
struct Texture {
    enum class Wrap { repeat, mirrored, clamp };
    std::shared_ptr<const Image> image; ///< never null
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false; ///< true: nearest texel; false: bilinear over four texels
    bool srgb = false;    ///< red, green and blue are sRGB; each texel is decoded, then filtered
    std::uint32_t uv_set = 0; ///< index into Mesh::uv, 0 or 1
    /// Rows of KHR_texture_transform, which maps the mesh's (u, v, 1) to texture space.
    vec3 u_row{1, 0, 0}, v_row{0, 1, 0};
    bool operator==(const Texture&) const = default;
};

/// Optical model of a surface, the same for raster and rays. It is evaluated at the visible point,
/// with the textures' values there. Let c = albedo (times texture, times the vertices' colour), m =
/// metallic and a = roughness. The diffuse colour is c (1 - m). F0 = mix(dielectric_f0, c, m), and
/// F90 = mix(dielectric_f90, 1, m). Up to a = .04, the surface shows R times what the mirrored ray
/// sees, plus (1 - R) times its diffuse light, with R = F0 + (F90 - F0) (1 - cos)^5 (Schlick 1994).
/// A rougher surface shows a GGX lobe (shaders/lib/math/lobe.glsl) with this Fresnel term, plus 1
/// minus the lobe's albedo times its diffuse light. With `mirror`, R is `reflectance` everywhere. A
/// clear coat of index 1.5 covers the share `clearcoat` of both (KHR_materials_clearcoat). In rays,
/// glass (scene::is_glass) reflects R of Fresnel's equations and transmits c (1 - R).
struct Material {
    std::string name;
    vec3 albedo{0};          ///< base colour, linear, in [0,1]
    vec3 emission{0};        ///< emitted radiance (Ke)
    bool mirror = false;     ///< reflects `reflectance` of all light, sharply, at any angle
    vec3 reflectance{1};     ///< reflectance of a mirror, each channel in [0,1]
    bool two_sided = false;  ///< the normal turns to the viewer; an open lamp shines both ways
    bool front_only = false; ///< back invisible to camera and reflected rays; not for mirrors
    bool unlit = false;      ///< shows its albedo in any light (KHR_materials_unlit)
    float metallic = 0, roughness = 1, clearcoat = 0, clearcoat_roughness = 0;
    vec3 dielectric_f0{0};  ///< reflectance of the part that is no metal, seen head-on; glass: .04
    vec3 dielectric_f90{0}; ///< that at grazing angle; 0 for both: a Lambertian surface
    float transmission = 0; ///< share of light not reflected that passes through, 0 to 1
    float ior = 1.5f, dispersion = 0; ///< of what transmits light; dispersion: 20 / Abbe number
    bool solid = false; ///< closed meshes are bodies that refract and absorb, else thin sheets
    vec3 absorption{0}; ///< in solid bodies, per world unit: light falls by e^-absorption
    float alpha = 1, alpha_cutoff = 0; ///< parts with less alpha than the cutoff are cut out
    bool blended = false; ///< covers the share `alpha`; shadows and mirrors are cut at the cutoff
    /// sRGB with alpha; sRGB; linear, with metallic in blue and roughness in green.
    std::optional<Texture> albedo_texture, emission_texture, roughness_texture;
    std::optional<Texture> normal_texture; ///< normals in tangent space, linear, as in glTF
    float normal_scale = 1;                ///< factor of the normals' x and y
    /// Radiance with which its meshes light the scene. None: `emission`, or no light if a texture
    /// varies the emission.
    std::optional<vec3> light;

    bool operator==(const Material&) const = default;
};

} // namespace catoptric::scene
