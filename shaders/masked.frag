// What is cut out casts no shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/material.glsl"

layout(push_constant, scalar) uniform Push { Draw draw; };
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_colour;

void main() {
    if (is_cut_out(draw.object, Attribute(in_uv, in_colour))) discard;
}
