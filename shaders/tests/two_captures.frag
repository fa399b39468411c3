// Shader of tests/reflect/two_captures_test.cpp: the mean of the colours that two captures of a mirror show in the reflected
// direction.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#define OWN_LOOKUP_COLOUR
#include "lib/constants.glsl"
#include "lib/probe.glsl"

layout(constant_id = OWN_CONSTANTS) const float share = 0.5; // of the second capture
layout(set = 0, binding = 20) uniform FACES(second);

vec3 second_colour(uint mirror, vec3 direction) {
    int face = cube_face(direction);
    vec3 c = cube_coordinates(face, direction);
    vec3 at = vec3(c.xy / c.z * 0.5 + 0.5, float(first_face_layer_of_mirror(mirror)) + float(face));
#define SECOND(i) textureLod(FACES_OF(second, i), at, 0.0).rgb
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, SECOND)
}
vec3 lookup_colour(uint mirror, Lookup lookup) {
    return mix(captured_colour(mirror, lookup.direction), second_colour(mirror, lookup.direction), share);
}
float distance_of_last_search_hit() { return 0.0; }
void set_distance_of_last_search_hit(float distance) {}

Lookup search(uint mirror, vec3 offset, vec3 direction) { return Lookup(direction, kHit, 0.0, 0.0); }
#include "lib/mirror.glsl"
