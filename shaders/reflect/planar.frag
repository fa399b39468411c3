// Technique `planar`: draws a flat mirror. The reflection is the same pixel of the mirrored view, whose eye is as far
// behind the mirror's plane as the camera is in front. The shader can add the mirror's diffuse and emitted light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/lit.glsl"

layout(set = 0, binding = 20) uniform sampler2D mirrored;

void main() {
    vec3 facet = cross(dFdx(from_eye), dFdy(from_eye));
    discard_cut_out_fragments();
    vec3 n = normalize(normal);
    Surface surface = find_surface_at_fragment(n, facet);
    count_work_once(kWorkColourLookups);
    vec3 shown = surface.reflectance * texelFetch(mirrored, ivec2(gl_FragCoord.xy), 0).rgb;
    if (lights_mirrors != 0u) shown += shade_drawn_fragment(surface, n, facet);
    write_captured_surface(shown);
}
