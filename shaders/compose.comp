// What the screen shows: exposure, clamp, sRGB curve, 8 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = HDR_BINDING, rgba32f) readonly uniform image2D hdr;
layout(set = 0, binding = PICTURE_BINDING, rgba8) writeonly uniform image2D picture;
layout(push_constant, scalar) uniform Push { float gain; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(hdr)))) return;
    vec3 c = imageLoad(hdr, pixel).rgb * gain;
    imageStore(picture, pixel, vec4(srgb_encoded(c.r), srgb_encoded(c.g), srgb_encoded(c.b), 1));
}
