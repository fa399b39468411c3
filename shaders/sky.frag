// Draws the environment where a view ray meets no surface, in captures and in the camera's view.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/environment.glsl"
#include "lib/surface.glsl"

void main() {
    write_captured_surface(environment_radiance(normalize(from_eye)));
    // The environment has no surface, so a capture stores the distance +infinity. The camera's view stores no distances
    // (distance_scale 0) but tracer numbers, and 0 means that no tracer takes the pixel.
    out_distance = distance_scale > 0.0 ? uintBitsToFloat(0x7f800000u) : 0.0;
    out_more = vec4(0);
}
