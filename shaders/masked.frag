// What is cut out casts no shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/material.glsl"

layout(location = 13) flat in uvec2 object_mirror; // see lib/drawn.glsl
layout(location = 3) in vec4 in_uv;
layout(location = 4) in vec4 in_colour;

void main() {
    if (is_cut_out(object_mirror.x, Attribute(in_uv, in_colour))) discard;
}
