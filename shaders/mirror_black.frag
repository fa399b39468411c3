// A mirror whose surroundings nobody has captured. LIT: what light it throws back itself is there.
#version 460
#extension GL_GOOGLE_include_directive : require
#ifdef LIT
#include "lib/lit.glsl"
#else
#include "lib/surface.glsl"
#endif

void main() {
    vec3 shown = vec3(0);
#ifdef LIT
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
#endif
#ifdef PEEL
    if (is_peeled()) discard;
#endif
    leave_out_what_is_cut();
#ifdef LIT
    vec3 n = normalize(normal);
    Surface surface = surface_here(n, facet);
    shown = shade(surface, surface_position(), n, lit_facet(surface.detail, facet));
#endif
    write_surface(shown);
}
