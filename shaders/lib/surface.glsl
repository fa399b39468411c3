// What the fragment shaders of captures and view share: inputs, outputs, and how a distance is stored.
#ifndef CATOPTRIC_SURFACE_GLSL
#define CATOPTRIC_SURFACE_GLSL

#include "lib/bindings.glsl"

layout(push_constant, scalar) uniform Push { Draw draw; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 from_eye; // position - eye

layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_distance; // only captures that hold distances keep it

// 1 stores scene units; unorm8 stores distance / range.
layout(constant_id = 0) const float distance_scale = 1.0;

const float kLargestHalf = 65504.0;

// Colour saturates below the largest half, so that no capture ever holds an infinity.
void write_surface(vec3 colour) {
    out_colour = vec4(min(colour, vec3(kLargestHalf)), 1);
    out_distance = length(from_eye) * distance_scale;
}

#endif
