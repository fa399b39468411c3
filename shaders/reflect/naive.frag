// Technique `naive`: plain environment mapping, as in parts one and two of the seed report. The reflected direction is
// looked up unchanged, as if the surroundings were infinitely far away.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#include "lib/probe.glsl"

Lookup search(uint mirror, vec3 offset, vec3 direction) { return Lookup(direction, kHit, 0.0, 0.0); }
#include "lib/mirror.glsl"
