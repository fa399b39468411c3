// Marks every pixel of a mirror for the ray tracer. The mirror looks nothing up in a capture.
// #first tells the tracer the triangle, too, so that it needs no camera ray (lib/first_hit.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/first_hit.glsl"
#include "lib/surface.glsl"

layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;

void main() {
    discard_cut_out_fragments();
    write_fragment_outputs(vec3(0));
#ifdef FIRST_HIT
    out_colour = make_first_hit_words(uint(gl_PrimitiveID), drawn_object_index(), drawn_mirror_number(), tracer);
#endif
    out_distance = float(tracer);
}
