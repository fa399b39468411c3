// Computes one level of a box-filtered chain of images: level 1 from the images themselves, such as captured colour, other
// levels from the level below. A texel is the mean over its area of the level below.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 20) uniform sampler2DArray unfiltered; // cube faces of one array of captures, or a picture
layout(set = 0, binding = 21, rgba16f) readonly uniform image2DArray below;
layout(set = 0, binding = 22, rgba16f) writeonly uniform image2DArray level;
layout(constant_id = OWN_CONSTANTS) const uint from_level = 0u; // 0: the level below is the image itself

vec3 colour_of_level_below(ivec3 texel) {
    count_work_once(kWorkColourLookups);
    return from_level != 0u ? imageLoad(below, texel).rgb : texelFetch(unfiltered, texel, 0).rgb;
}

void main() {
    ivec2 size = imageSize(level).xy, texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 source = from_level != 0u ? imageSize(below).xy : textureSize(unfiltered, 0).xy;
    int layer = int(gl_WorkGroupID.z);
    if (texel.x >= size.x || texel.y >= size.y) return;
    // The width and height of a texel in texels of the level below. If the level below has an odd side, a texel covers parts of
    // texels.
    vec2 scale = vec2(source) / vec2(size);
    vec2 low = vec2(texel) * scale, high = low + scale;
    ivec2 first = ivec2(low), last = min(ivec2(ceil(high)), source) - 1;
    vec3 sum = vec3(0);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec2 share = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
            sum += share.x * share.y * colour_of_level_below(ivec3(x, y, layer));
        }
    imageStore(level, ivec3(texel, layer), vec4(min(sum / (scale.x * scale.y), vec3(kLargestHalf)), 1));
}
