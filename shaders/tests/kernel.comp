// tests/support/kernel.hpp: the ray tracer's own walk over rays from a buffer, one ray an invocation.
// Everything travels as words, so that no bit of a float is lost on the way.
#version 460
#extension GL_GOOGLE_include_directive : require
#define BVH_NODES_BINDING 0
#define BVH_TRIANGLES_BINDING 1
#include "lib/constants.glsl"
layout(constant_id = EXACT_SPHERES_CONSTANT) const uint exact_spheres = 0u;
#define TRACE_BALLS (exact_spheres != 0u)
#include "lib/trace.glsl"

layout(local_size_x = TRACE_LOCAL_SIZE) in;
layout(set = 0, binding = 2, std430) readonly buffer Rays { uvec4 rays[]; };  // origin, t_max; direction, leaves
layout(set = 0, binding = 3, std430) writeonly buffer Hits { uvec4 hits[]; }; // t, weights; triangle, object, outcome, steps
layout(set = 0, binding = 4, std430) readonly buffer Lows { uvec4 lows[]; };  // what origins lack
layout(push_constant) uniform Push {
    uint count;
    uint skipped;  // flags of triangles that the rays pass by
    uint occluded; // 1: ask any_hit, which says no more than whether
};

const uint kFound = 1u, kExhausted = 2u; // outcome

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uvec4 from = rays[2u * i];
    uvec4 along = rays[2u * i + 1u];
    Ray ray = Ray(uintBitsToFloat(from.xyz), uintBitsToFloat(along.xyz), along.w);
    float t_max = uintBitsToFloat(from.w);
    trace_low = uintBitsToFloat(lows[i].xyz);
    Hit hit = Hit(0.0, vec3(0), 0u, 0u, 0u, 0u);
    bool found = occluded != 0u ? any_hit(ray, t_max, skipped) : closest_hit(ray, t_max, skipped, hit);
    if (!found || occluded != 0u) hit = Hit(0.0, vec3(0), 0u, 0u, 0u, 0u);
    uint outcome = (found ? kFound : 0u) | (trace_exhausted ? kExhausted : 0u);
    hits[2u * i] = uvec4(floatBitsToUint(hit.t), floatBitsToUint(hit.barycentric));
    hits[2u * i + 1u] = uvec4(hit.triangle, hit.object, outcome, trace_steps);
}
