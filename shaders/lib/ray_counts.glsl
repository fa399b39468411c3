// Code that all ray tracing dispatches share: the order of work groups, and the ray counters.
#ifndef CATOPTRIC_RAY_COUNTS_GLSL
#define CATOPTRIC_RAY_COUNTS_GLSL

#define TRACE_COUNTS_LANES
#include "lib/whitted.glsl"

layout(set = 0, binding = COUNTERS_BINDING, scalar) buffer CountersBuffer { Counters value; } counters;

layout(constant_id = GROUPS_IN_ORDER_CONSTANT) const uint groups_in_order = 0u;

// Returns the number of the work group whose pixels this work group traces. A software driver gives each of its threads
// a contiguous run of work groups, and neighbouring work groups cost about the same. Scattered numbers let all threads
// finish at about the same time. Work groups are numbered row by row.
uint find_assigned_work_group() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
#ifdef NAIVE
    return group;
#else
    const uint kShufflePrime = 2531u;
    uint count = gl_NumWorkGroups.x * gl_NumWorkGroups.y;
    return groups_in_order != 0u || count % kShufflePrime == 0u || count > 0xffffffffu / kShufflePrime ? group
        : group * kShufflePrime % count;
#endif
}

// Adds the rays of an invocation to the counters. Every invocation calls this function once, at its end.
void count_rays() {
    uint primary = subgroupAdd(camera_rays);
    uint mirrors = subgroupAdd(mirror_rays);
    uint shadows = subgroupAdd(shadow_rays);
    uint exhausted = subgroupAdd(trace_exhausted ? 1u : 0u);
    uint longest = subgroupMax(trace_steps);
    if (count_work != 0u) {
        add_to_work_count(kWorkCameraRays, camera_rays);
        add_to_work_count(kWorkMirrorRays, mirror_rays);
        add_to_work_count(kWorkShadowRays, shadow_rays);
        add_to_work_count(kWorkBvhNodes, nodes_visited);
        add_to_work_count(kWorkTriangleTests, triangles_tested);
        add_to_work_count(kWorkNodeLanes, node_lanes);
        add_to_work_count(kWorkTriangleLanes, triangle_lanes);
    }
    if (!subgroupElect()) return;
    atomicAdd(counters.value.primary_rays, primary);
    atomicAdd(counters.value.mirror_rays, mirrors);
    atomicAdd(counters.value.shadow_rays, shadows);
    if (exhausted > 0u) atomicAdd(counters.value.exhausted, exhausted);
    atomicMax(counters.value.longest_walk, longest);
}

#endif
