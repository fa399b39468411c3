// What is seen where the scene ends, in captures and in the view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/environment.glsl"
#include "lib/surface.glsl"

void main() {
    write_surface(environment(normalize(from_eye)));
    // Nothing is there; a view that leaves pixels to tracing has no distances.
    out_distance = distance_scale > 0.0 ? uintBitsToFloat(0x7f800000u) : 0.0;
    out_more = vec4(0);
}
