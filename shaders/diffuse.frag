// Anything that is no mirror, in captures and in the view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/shadow.glsl"
#include "lib/surface.glsl"

layout(constant_id = 1) const uint shadow = 1u;

float light_visible(uint light, vec3 at, vec3 n, vec3 direction, float distance) {
    return shadow == kShadowMap ? shadow_map_visible(light, at, n) : 1.0;
}
#include "lib/lighting.glsl"

void main() { write_surface(shade(surfaces[draw.object], position, normalize(normal))); }
