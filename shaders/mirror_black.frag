// Draws a mirror that has no capture. The mirror is black, or shows only its diffuse and emitted light.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#include "lib/lit.glsl"

void main() {
    vec3 shown = vec3(0), facet = vec3(0);
    if (lights_mirrors != 0u) facet = cross(dFdx(from_eye), dFdy(from_eye));
    if (peels != 0u && is_peeled_from_second_layer()) discard;
    discard_cut_out_fragments();
    if (lights_mirrors != 0u) {
        vec3 n = normalize(normal);
        Surface surface = find_surface_at_fragment(n, facet);
        shown = shade_drawn_fragment(surface, n, facet);
    }
    write_fragment_outputs(shown);
}
