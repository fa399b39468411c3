// A mirror whose surroundings nobody has captured.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/surface.glsl"

void main() {
#ifdef PEEL
    if (is_peeled()) discard;
#endif
    write_surface(vec3(0));
}
