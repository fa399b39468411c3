// The light that a surface throws back itself, in captures and in the view.
#ifndef CATOPTRIC_LIT_GLSL
#define CATOPTRIC_LIT_GLSL

#include "lib/surface.glsl"

#ifdef UNSHADOWED
float light_visible(uint light, vec3 at, vec3 n, vec3 direction, float distance) { return 1.0; }
#else
#include "lib/shadow.glsl"
float light_visible(uint light, vec3 at, vec3 n, vec3 direction, float distance) {
    return shadow_map_visible(light, at, n, surface_error(n));
}
#endif
#include "lib/lighting.glsl"

#endif
