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
layout(set = 0, binding = 23) uniform sampler2DArray distances; // of what the images show
layout(constant_id = OWN_CONSTANTS) const uint from_level = 0u; // 0: the level below is the image itself
// 1: only a part of the image has a value. The mean is taken over texels that have one, and a texel beside the part gets
// the value of the nearest.
layout(constant_id = OWN_CONSTANTS + 1) const uint has_area = 0u;
// 1: the fourth component of a texel is the mean of 1 / distance, 0 for infinity; 0: it is 1.
layout(constant_id = OWN_CONSTANTS + 2) const uint has_distances = 0u;
layout(push_constant, scalar) uniform Push {
    uvec2 first;           // the texel that the dispatch begins with
    uvec2 lowest, highest; // texels of the level below that have a value
} area;
const float kMinShare = 1e-6; // weight of a texel beside the box, which counts only if no other does

vec4 colour_of_level_below(ivec3 texel) {
    count_work_once(kWorkColourLookups);
    if (from_level != 0u) return imageLoad(below, texel);
    vec3 colour = texelFetch(unfiltered, texel, 0).rgb;
    if (has_distances == 0u) return vec4(colour, 1);
    count_work_once(kWorkDistanceLookups);
    // The least distance keeps the inverse finite.
    const float kMinDistance = 1e-4;
    return vec4(colour, 1.0 / max(texelFetch(distances, texel, 0).r, kMinDistance));
}

void main() {
    ivec2 size = imageSize(level).xy, texel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 source = from_level != 0u ? imageSize(below).xy : textureSize(unfiltered, 0).xy;
    int layer = int(gl_WorkGroupID.z);
    if (has_area != 0u) texel += ivec2(area.first);
    if (texel.x >= size.x || texel.y >= size.y) return;
    // The width and height of a texel in texels of the level below. If the level below has an odd side, a texel covers parts of
    // texels.
    vec2 scale = vec2(source) / vec2(size);
    vec2 low = vec2(texel) * scale, high = low + scale;
    ivec2 first = ivec2(low), last = min(ivec2(ceil(high)), source) - 1;
    vec4 sum = vec4(0);
    float weights = scale.x * scale.y;
    if (has_area != 0u) {
        first = clamp(first, ivec2(area.lowest), ivec2(area.highest));
        last = clamp(last, ivec2(area.lowest), ivec2(area.highest));
        weights = 0.0;
    }
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec2 share = min(high, vec2(x + 1, y + 1)) - max(low, vec2(x, y));
            if (has_area != 0u) {
                share = max(share, kMinShare);
                weights += share.x * share.y;
            }
            sum += share.x * share.y * colour_of_level_below(ivec3(x, y, layer));
        }
    imageStore(level, ivec3(texel, layer), vec4(min(sum.rgb / weights, vec3(kLargestHalf)), has_distances != 0u ? min(sum.a / weights, kLargestHalf) : 1.0));
}
