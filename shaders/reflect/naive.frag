// Plain environment mapping (the report's parts one and two): the reflected direction as it is, as if
// the surroundings were infinitely far away.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/probe.glsl"

vec3 reflected(uint mirror, vec3 offset, vec3 direction) { return captured_colour(mirror, direction); }
#include "lib/mirror.glsl"
