// Draws glyphs and controls over a window's picture. Alpha comes from the font texture, which stores coverage in one
// byte a texel. Glyphs lie on whole pixels, so the nearest texel is exact.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(push_constant, scalar) uniform Push { OverlayParameters overlaying; };
layout(set = 0, binding = 21, scalar) readonly buffer Font { uint font[]; };
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 colour;
layout(location = 0) out vec4 out_colour;

void main() {
    uvec2 texel = min(uvec2(max(uv, vec2(0)) * vec2(overlaying.font)), overlaying.font - 1);
    uint at = texel.y * overlaying.font.x + texel.x;
    out_colour = vec4(colour.rgb, colour.a * unpackUnorm4x8(font[at / 4u])[at % 4u]);
}
