// Computes one narrow level of captures for rough reflections with few samples: one in the middle, and up to three rings of
// four. Radii, weights and box-filtered levels of the samples are fitted to a GGX lobe that is seen along its normal
// (engine/reflect/rough.cpp), as in Manson and Sloan, "Fast Filtering of Reflection Probes", 2016.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
// Box-filtered levels, from 1, of one array of captures, with mipmaps.
layout(set = 0, binding = 21) uniform samplerCubeArray boxes;
layout(set = 0, binding = 22, rgba16f) writeonly uniform image2DArray level;
// Four samples at an angle to the lobe's axis. The weights of all samples add up to 1.
struct LobeRing {
    float sine, cosine; // of the angle
    float from;         // the box-filtered level that is read, from 0 for the first level of `boxes`
    float weight;       // of each of the four samples
};
layout(push_constant, scalar) uniform Push {
    LobeRing rings[3]; // the first and the third ring lie on the diagonals of the tangents, the second on the tangents
    float middle_from, middle_weight;
    uint ring_count; // from 1
};

vec3 read_boxes(vec3 direction, float from) {
    count_work_once(kWorkColourLookups);
    return textureLod(boxes, vec4(direction, int(gl_WorkGroupID.z) / 6), from).rgb;
}

void main() {
    int edge = imageSize(level).x, layer = int(gl_WorkGroupID.z);
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (texel.x >= edge || texel.y >= edge) return;
    vec2 place = (2.0 * vec2(texel) + 1.0) / float(edge) - 1.0;
    vec3 normal = normalize(cube_direction(layer % 6, vec3(place, 1))), tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    vec3 sum = middle_weight * read_boxes(normal, middle_from);
    vec3 across = sqrt(0.5) * (tangent + bitangent), along = sqrt(0.5) * (tangent - bitangent);
    uint i = 0u;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        LobeRing ring = rings[i];
        vec3 axis = ring.cosine * normal;
        sum += ring.weight * (read_boxes(axis + ring.sine * across, ring.from) + read_boxes(axis - ring.sine * across, ring.from) +
                              read_boxes(axis + ring.sine * along, ring.from) + read_boxes(axis - ring.sine * along, ring.from));
        vec3 turned = sqrt(0.5) * (across + along); // the next ring is turned by an eighth
        along = sqrt(0.5) * (across - along);
        across = turned;
    } while (++i < ring_count);
    imageStore(level, ivec3(texel, layer), vec4(min(sum, vec3(kLargestHalf)), 1));
}
