// Shader of tests/support/kernel.hpp: runs the ray tracer's BVH walk for rays from a buffer, one ray per invocation.
// Buffers hold 32-bit words instead of floats, so that no bit of a float changes.
#version 460
#extension GL_GOOGLE_include_directive : require
#define BVH_NODES_BINDING 0
#define BVH_TRIANGLES_BINDING 1
#include "lib/constants.glsl"
layout(constant_id = EXACT_SPHERES_CONSTANT) const uint exact_spheres = 0u;
#define TRACE_BALLS (exact_spheres != 0u)
#include "lib/trace.glsl"

layout(local_size_x = TRACE_LOCAL_SIZE) in;
// Two elements of four words for each ray: origin and t_max; direction and `leaves`.
layout(set = 0, binding = 2, std430) readonly buffer Rays { uvec4 rays[]; };
// Two elements of four words for each ray's hit: t and the barycentric weights; triangle, object, outcome and number of
// steps.
layout(set = 0, binding = 3, std430) writeonly buffer Hits { uvec4 hits[]; };
layout(set = 0, binding = 4, std430) readonly buffer Lows { uvec4 lows[]; };  // rounding errors of the rays' origins
layout(push_constant) uniform Push {
    uint count;
    uint skipped;  // flags of triangles that rays ignore
    uint occluded; // 1: call has_any_hit, which returns only whether the ray has a hit
};

const uint kFoundHitBit = 1u, kStepLimitBit = 2u; // bits of a hit's outcome

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uvec4 from = rays[2u * i];
    uvec4 along = rays[2u * i + 1u];
    Ray ray = Ray(uintBitsToFloat(from.xyz), uintBitsToFloat(along.xyz), along.w);
    float t_max = uintBitsToFloat(from.w);
    trace_low = uintBitsToFloat(lows[i].xyz);
    TraceHit hit = TraceHit(0.0, vec3(0), 0u, 0u, 0u, 0u);
    bool found = occluded != 0u ? has_any_hit(ray, t_max, skipped) : find_closest_hit(ray, t_max, skipped, hit);
    if (!found || occluded != 0u) hit = TraceHit(0.0, vec3(0), 0u, 0u, 0u, 0u);
    uint outcome = (found ? kFoundHitBit : 0u) | (trace_exhausted ? kStepLimitBit : 0u);
    hits[2u * i] = uvec4(floatBitsToUint(hit.t), floatBitsToUint(hit.barycentric));
    hits[2u * i + 1u] = uvec4(hit.triangle, hit.object, outcome, trace_steps);
}
