// Discards fragments that fail the alpha test when a shadow map is drawn, so that cut-out parts cast no shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/material.glsl"

layout(location = 13) flat in uvec3 drawn_numbers; // object, mirror and material number (lib/drawn.glsl)
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_colour;

void main() {
    if (fails_alpha_test(drawn_numbers.z, VertexAttribute(in_uv, in_colour))) discard;
}
