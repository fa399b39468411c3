// A flat mirror: what a view of its own shows at this very pixel, made by an eye as far behind the mirror as the
// picture's is in front of it. LIT: and what light it throws back itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef LIT
#include "lib/lit.glsl"
#else
#include "lib/surface.glsl"
#endif

layout(set = 0, binding = 20) uniform sampler2D mirrored;

void main() {
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    leave_out_what_is_cut();
    vec3 n = normalize(normal);
    Surface surface = surface_here(n, facet);
    vec3 shown = surface.reflectance * texelFetch(mirrored, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef LIT
    shown += shade(surface, surface_position(), n, lit_facet(surface.detail, facet));
#endif
    write_surface(shown);
}
