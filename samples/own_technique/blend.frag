// Between plain environment mapping (amount 0: the reflected direction as it is) and one step of
// correction by the captured distance (amount 1).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/constants.glsl"
#include "lib/probe.glsl"

layout(constant_id = OWN_CONSTANTS) const float amount = 0.5;

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float distance = captured_distance(mirror, direction);
    vec3 corrected = parallax_direction(offset, direction, distance);
    vec3 blended = amount == 1.0 ? corrected : normalize(mix(direction, corrected, amount));
    return Lookup(blended, is_miss(distance) ? kMiss : kHit, 0.0, 0.0);
}
#include "lib/mirror.glsl"
