// One correction step (the report's part three; first step of Szirmay-Kalos et al. 2005, "Approximate
// Ray-Tracing on the GPU with Distance Impostors"): what is seen along the reflected direction from the
// capture's centre is taken for a plane across that direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/probe.glsl"

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float distance = captured_distance(mirror, direction);
    return Lookup(parallax_direction(offset, direction, distance), is_miss(distance) ? kMiss : kHit, 0.0, 0.0);
}
#include "lib/mirror.glsl"
