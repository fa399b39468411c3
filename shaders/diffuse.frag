// Anything that is no mirror, in captures and in the view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/lit.glsl"

void main() {
    vec3 facet = details != 0u ? cross(dFdx(from_eye), dFdy(from_eye)) : vec3(0);
#ifdef PEEL
    if (is_peeled()) discard;
#endif
    leave_out_what_is_cut();
    vec3 n = normalize(normal);
    Surface surface = surface_here(n, facet);
    vec3 shown = shade(surface, surface_position(), n, lit_facet(surface.detail, facet));
    // A smooth surface that is no mirror shows what surrounds the scene, and nothing nearer.
    if (details != 0u && surface.reflectance != vec3(0))
        shown += surface.reflectance * environment(mirror_direction(normalize(seen_along()), n, normalize(facet)));
    write_surface(shown);
}
