// Technique `parallax`: one step of parallax correction, as in part three of the seed report. This is the first step of
// Szirmay-Kalos et al. 2005, "Approximate Ray-Tracing on the GPU with Distance Impostors". The surface that the
// capture's centre sees in the reflected direction is assumed to be a plane perpendicular to that direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#include "lib/probe.glsl"

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float distance = captured_distance(mirror, direction);
    return Lookup(parallax_direction(offset, direction, distance), is_miss(distance) ? kMiss : kHit, 0.0, 0.0);
}
#include "lib/mirror.glsl"
