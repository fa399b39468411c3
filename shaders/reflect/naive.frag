// Plain environment mapping (the report's parts one and two): the reflected direction as it is, as if
// the surroundings were infinitely far away.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/probe.glsl"

Lookup search(uint mirror, vec3 offset, vec3 direction) { return Lookup(direction, kHit, 0.0, 0.0); }
#include "lib/mirror.glsl"
