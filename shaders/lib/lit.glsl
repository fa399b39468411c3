// Diffuse and emitted light of a drawn surface, in captures and in the camera's view.
#ifndef CATOPTRIC_LIT_GLSL
#define CATOPTRIC_LIT_GLSL

#include "lib/surface.glsl"

#include "lib/shadow.glsl"

// 1: the emission of surfaces is left out.
layout(constant_id = LEAVES_OUT_EMISSION_CONSTANT) const uint leaves_out_emission = 0u;

#ifdef FIRST_HIT
bool shadow_is_open = false; // whether the shadow map could not tell whether some light reaches the surface
#endif

#ifndef FIRST_HIT
// The unit normal of the triangle, for soft shadows. Derivatives come before any discard.
vec3 fragment_facet = soft_shadows == 0u ? vec3(0) : normalize(cross(dFdx(from_eye), dFdy(from_eye)));
#endif

float visible_share_of_light(uint light, vec3 at, vec3 n, vec3 direction, float distance) {
    if (has_shadow_map == 0u) return 1.0;
#ifdef FIRST_HIT
    float visible;
    if (!find_light_share_by_shadow_map(light, at, n, fragment_position_error(n), visible)) shadow_is_open = true;
    return visible;
#else
    return sample_hard_or_soft_shadow_map(light, at, n, fragment_facet, fragment_position_error(n));
#endif
}
#define USES_AMBIENT_OCCLUSION
float visible_hemisphere_share_here();
#include "lib/lighting.glsl"
float visible_hemisphere_share_here() { return visible_hemisphere_share(ivec2(gl_FragCoord.xy)); }

// Returns the radiance of the drawn surface without the reflections that captures show (shade_surface). `n` is the unit
// shading normal, and `facet` points along the triangle's normal.
vec3 shade_drawn_fragment(Surface surface, vec3 n, vec3 facet) {
    if (leaves_out_emission != 0u) surface.emission = vec3(0);
    return shade_surface(surface, fragment_surface_position(), n, find_facet_normal_for_shading(surface.detail, facet),
                         -normalize(direction_from_viewer()), surface.reflectance != vec3(0));
}

#endif
