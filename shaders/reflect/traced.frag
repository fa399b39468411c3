// Marks every pixel of a mirror for the ray tracer. The mirror looks nothing up in a capture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/surface.glsl"

layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;

void main() {
    leave_out_what_is_cut();
    write_surface(vec3(0));
    out_distance = float(tracer);
}
