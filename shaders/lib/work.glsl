// Counted work: how often shaders look textures up and trace rays. Only frames that count work
// (engine/graph/work_counter.hpp) are drawn with count_work = 1. In all other frames the engine removes this code, and
// the buffer's binding, before the driver sees the shader.
#ifndef CATOPTRIC_WORK_GLSL
#define CATOPTRIC_WORK_GLSL

#include "lib/constants.glsl"
#include "shared.h"

layout(constant_id = COUNT_WORK_CONSTANT) const uint count_work = 0u;

// The work counts of the pass. Each count is a low word and a high word.
layout(set = 0, binding = 43, scalar) buffer WorkBuffer { uvec2 work_counts[kShaderWorkKindCount]; };

// Adds `count` to the pass's count of work kind `kind` (kWork... in shared.h). Helper invocations of a fragment shader
// add nothing.
void add_to_work_count(uint kind, uint count) {
    if (count_work == 0u || count == 0u) return;
    uint before = atomicAdd(work_counts[kind].x, count);
    if (before + count < before) atomicAdd(work_counts[kind].y, 1u);
}
void count_work_once(uint kind) {
    if (count_work != 0u) add_to_work_count(kind, 1u);
}

#ifdef COUNTS_LANES
// 0: the device has no subgroup operations in fragment shaders, so the shader counts no executed lanes.
layout(constant_id = COUNTS_LANES_CONSTANT) const uint counts_lanes = 1u;
#endif
// Adds `count` to the pass's count of work kind `kind` for each subgroup that executes this call. Only fragment shaders
// that define COUNTS_LANES count subgroups. A helper invocation covers no sample, and never stands for its subgroup,
// because it cannot count.
void count_work_of_subgroup(uint kind, uint count) {
#ifdef COUNTS_LANES
    if (count_work != 0u && counts_lanes != 0u && gl_SampleMaskIn[0] != 0) {
        if (subgroupElect()) add_to_work_count(kind, count);
    }
#endif
}
void count_distance_lookup() {
    count_work_once(kWorkDistanceLookups);
    count_work_of_subgroup(kWorkDistanceLanes, 1u);
}
void count_colour_lookups(uint count) {
    add_to_work_count(kWorkColourLookups, count);
    count_work_of_subgroup(kWorkColourLanes, count);
}
// Called in each step of a search's loops.
void count_search_step() { count_work_of_subgroup(kWorkSearchLanes, 1u); }

#endif
