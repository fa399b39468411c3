// Shadows of glass: light on its straight way to a surface passes bodies of glass, whose surfaces and insides attenuate it.
// The light is not bent, so there are no caustics. At each surface the share that is not reflected passes (Fresnel's equations
// at the angle between the straight ray and the surface's normal, outside the glass), times the tint. Inside a solid body
// light falls by e^-absorption per scene unit. The product is the same in any order of the surfaces, so it is summed up as an
// optical depth: light falls by e^-depth. Glass itself is lit as if no glass were in the way.
#ifndef CATOPTRIC_GLASS_SHADOW_GLSL
#define CATOPTRIC_GLASS_SHADOW_GLSL

#include "lib/constants.glsl"
#include "lib/material.glsl"

// 1: the scene has glass that tints the light behind it (scene::Scene::tints_glass_shadows).
layout(constant_id = TINTS_SHADOWS_CONSTANT) const uint tints_shadows = 0u;

// The share of each colour of the light that passes glass on the way to a surface point. The point is that of the last
// call of visible_share_of_light.
vec3 light_tint = vec3(1);

// Returns the optical depth of a surface of glass with the base colour `albedo`. `cosine`: cosine of the angle between
// the ray and the surface's normal, 0 to 1.
vec3 glass_surface_depth(uint detail, vec3 albedo, VertexAttribute at, float cosine) {
    const float kMinShare = 1e-9; // far less than a picture shows, so that sums of depths stay finite
    MaterialParameters glass = read_material_parameters(detail);
    float cosine_behind, reflected = fresnel_dielectric(min(cosine, 1.0), glass.ior, cosine_behind);
    if ((glass.flags & kMaterialOpenSheetFlag) != 0u) reflected = sheet_reflectance(reflected);
    vec3 tint = albedo * at.colour.rgb * sample_texture(glass.albedo, at.uv).rgb;
    return -log(max((1.0 - reflected) * tint, vec3(kMinShare)));
}

// Returns the share of light that passes glass of the optical depth `depth`.
vec3 share_behind_glass(vec3 depth) { return exp(-max(depth, vec3(0))); }

bool is_solid_glass(uint detail) { return (read_material_parameters(detail).flags & kMaterialSolidFlag) != 0u; }

#endif
