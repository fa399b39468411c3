// Places the triangles of controls and text over a window's picture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Push { OverlayParameters overlaying; };
layout(set = 0, binding = 20, scalar) readonly buffer Corners { OverlayVertex corners[]; };
layout(location = 0) out vec2 out_uv;
layout(location = 1) out vec4 out_colour;

void main() {
    OverlayVertex corner = corners[gl_VertexIndex];
    gl_Position = vec4(2 * corner.position / vec2(overlaying.window) - 1, 0, 1);
    out_uv = corner.uv;
    out_colour = unpackUnorm4x8(corner.colour);
}
