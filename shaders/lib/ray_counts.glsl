// What dispatches of ray tracing share: which pixels a work group takes, and the counting of rays.
#ifndef CATOPTRIC_RAY_COUNTS_GLSL
#define CATOPTRIC_RAY_COUNTS_GLSL

#include "lib/whitted.glsl"

layout(set = 0, binding = COUNTERS_BINDING, scalar) buffer CountersBuffer { Counters value; } counters;

layout(constant_id = GROUPS_IN_ORDER_CONSTANT) const uint groups_in_order = 0u;

// Neighbouring work groups cost alike, and a software driver gives each of its threads one contiguous
// run of them: scattered, the threads finish together. Rows of work groups follow each other.
uint work_group() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
#ifdef NAIVE
    return group;
#else
    const uint kPrime = 2531u;
    uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    return groups_in_order != 0u || count % kPrime == 0u || count > 0xffffffffu / kPrime ? group : group * kPrime % count;
#endif
}

// Once for every invocation, at its end; `inside`: it traced a camera ray.
void count(bool inside) {
    uint primary = subgroupAdd(inside ? 1u : 0u);
    uint mirrors = subgroupAdd(mirror_rays);
    uint shadows = subgroupAdd(shadow_rays);
    uint exhausted = subgroupAdd(trace_exhausted ? 1u : 0u);
    uint longest = subgroupMax(trace_steps);
    if (!subgroupElect()) return;
    atomicAdd(counters.value.primary_rays, primary);
    atomicAdd(counters.value.mirror_rays, mirrors);
    atomicAdd(counters.value.shadow_rays, shadows);
    if (exhausted > 0u) atomicAdd(counters.value.exhausted, exhausted);
    atomicMax(counters.value.longest_walk, longest);
}

#endif
