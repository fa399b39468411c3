// Looking into a capture.
#ifndef CATOPTRIC_PROBE_GLSL
#define CATOPTRIC_PROBE_GLSL

#include "lib/bindings.glsl"

// Scene units of a stored 1: 1 for float formats, the range for unorm8.
layout(constant_id = 2) const float stored_unit = 1.0;

vec3 captured_colour(uint mirror, vec3 direction) {
    return textureLod(colour_cubes, vec4(direction, mirror), 0).rgb;
}

// Distance from the capture's centre, bilinear. Where one of the four texels holds nothing
// (+infinity), the sum is not finite and the nearest texel decides.
float captured_distance(uint mirror, vec3 direction) {
    float d = textureLod(distance_cubes, vec4(direction, mirror), 0).r;
    if (is_miss(d) || isnan(d)) d = textureLod(distance_cubes_nearest, vec4(direction, mirror), 0).r;
    return d * stored_unit;
}

#endif
