// Computes one level of captures for rough reflections: the captured colour, filtered by a GGX lobe that is seen along
// its normal (Karis, "Real Shading in Unreal Engine 4", 2013). Each sample reads a level of the box-filtered chain whose
// texels are as large as the part of the lobe for which the sample stands: filtered importance sampling (Krivanek and
// Colbert, "Real-time Shading with Filtered Importance Sampling", 2008).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// Box-filtered levels, from 1, of one array of captures, with mipmaps. Samples that stand for less than a texel of level 1
// read level 1, too: on the software driver, a choice between two images costs the time of both.
layout(set = 0, binding = 21) uniform samplerCubeArray boxes;
layout(set = 0, binding = 22, rgba16f) writeonly uniform image2DArray level;
layout(push_constant, scalar) uniform Push {
    float alpha; // width alpha of the lobe
    uint rings;  // number of rings of samples; each ring has four samples
};

// Area of a sample's box in areas for which the sample stands. Larger boxes blur the level more than the lobe does.
const float kOverlap = 0.5;

void main() {
    int edge = imageSize(level).x, layer = int(gl_WorkGroupID.z);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= edge || texel.y >= edge) return;
    vec2 place = (2.0 * vec2(texel) + 1.0) / float(edge) - 1.0;
    vec3 normal = normalize(cube_direction(layer % 6, vec3(place, 1))), tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    float captured_edge = 2.0 * float(textureSize(boxes, 0).x), texel_area = 4.0 * kPi / (6.0 * captured_edge * captured_edge);
    vec3 sum = vec3(0);
    float weights = 0.0;
    // Samples lie on rings of four. The mean direction of a ring is the lobe's axis, so filtering does not shift the
    // light.
    for (uint i = 0u; i < rings; ++i) {
        float u, v;
        hammersley_point(i, rings, u, v);
        vec3 drawn = sample_lobe_seen_head_on(alpha, v / 4.0, u);
        if (!(drawn.z > 0.0)) continue;
        float density = ggx_density(alpha, half_vector_between(vec3(0, 0, 1), drawn)) / 4.0;
        // A sample reads one level of the boxes, because a mix of two levels costs twice as much.
        float from = round(0.5 * log2(kOverlap / (float(4u * rings) * density * texel_area)));
        for (int turn = 0; turn < 4; ++turn) {
            vec4 place = vec4(drawn.x * tangent + drawn.y * bitangent + drawn.z * normal, layer / 6);
            vec3 colour = textureLod(boxes, place, from - 1.0).rgb;
            count_work_once(kWorkColourLookups);
            sum += drawn.z * colour;
            weights += drawn.z;
            drawn.xy = vec2(-drawn.y, drawn.x);
        }
    }
    imageStore(level, ivec3(texel, layer), vec4(min(sum / weights, vec3(kLargestHalf)), 1));
}
