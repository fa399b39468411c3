// Anything that is no mirror, in captures and in the view.
#version 460
#extension GL_GOOGLE_include_directive : require
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

void main() {
#ifdef PEEL
    if (is_peeled()) discard;
#endif
    write_surface(shade(draw.surface, surface_position(), normalize(normal)));
}
