// Diffuse and emitted light of a drawn surface, in captures and in the camera's view.
#ifndef CATOPTRIC_LIT_GLSL
#define CATOPTRIC_LIT_GLSL

#include "lib/surface.glsl"

#include "lib/shadow.glsl"

float light_visible(uint light, vec3 at, vec3 n, vec3 direction, float distance) {
    if (has_shadow_map == 0u) return 1.0;
    return shadow_map_visible(light, at, n, surface_error(n));
}
#include "lib/lighting.glsl"

#endif
