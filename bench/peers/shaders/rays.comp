// Traces a list of rays to their first hits with the engine's BVH walk.
#version 460
#extension GL_GOOGLE_include_directive : require
#define BVH_NODES_BINDING 0
#define BVH_TRIANGLES_BINDING 1
#include "lib/trace.glsl"

layout(local_size_x = TRACE_LOCAL_SIZE) in;
layout(set = 0, binding = 2) uniform samplerBuffer rays;                     // two texels per ray: origin, direction
layout(set = 0, binding = 3, std430) writeonly buffer Met { uvec2 met[]; }; // a peers::Met for each ray

const uint kNothing = 0xffffffffu;

void main() {
    uint i = gl_GlobalInvocationID.x;
    Ray ray = Ray(texelFetch(rays, int(2u * i)).xyz, texelFetch(rays, int(2u * i + 1u)).xyz, 0u);
    TraceHit hit;
    bool found = find_closest_hit(ray, kLargestFloat, 0u, hit);
    if (!trace_exhausted) met[i] = uvec2(floatBitsToUint(hit.t), found ? hit.triangle : kNothing);
}
