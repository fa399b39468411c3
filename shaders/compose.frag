// Converts the rendered picture to screen colours: applies exposure, clamps, and encodes as 8-bit sRGB.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"

layout(set = 0, binding = HDR_BINDING) uniform sampler2D hdr;
layout(push_constant, scalar) uniform Push { float gain; };
layout(location = 0) out vec4 picture;

void main() {
    vec3 c = texelFetch(hdr, ivec2(gl_FragCoord.xy), 0).rgb * gain;
    picture = vec4(srgb_from_linear_channel(c.r), srgb_from_linear_channel(c.g), srgb_from_linear_channel(c.b), 1);
}
