// Lists the stored starts from which paths go on (lib/path_start.glsl), and counts the work groups that trace them. Has as
// many work groups as the dispatch that stored the starts.
// No branch precedes a subgroup operation, because after a branch the lanes need not run together again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "lib/trace_list.glsl"
#include "lib/work.glsl"
#include "shared.h"

layout(local_size_x = 64) in; // 64 invocations: kPixelsPerListGroup
layout(set = 0, binding = STARTS_BINDING, scalar) readonly buffer Starts { PathStart starts[]; };
layout(set = 0, binding = START_LIST_BINDING, scalar) writeonly buffer StartList { uint start_list[]; };
layout(set = 0, binding = START_ARGUMENTS_BINDING, scalar) buffer StartArguments { PathStartArguments start_arguments; };

void list_starts_of_group(uint group) {
    uint place = group * kPixelsPerListGroup + gl_LocalInvocationIndex;
    bool is_listed = starts[place].bounce != kNoPathStart;
    uvec4 lanes = subgroupBallot(is_listed);
    uint listed = subgroupBallotBitCount(lanes), before = subgroupBallotExclusiveBitCount(lanes);
    bool is_first = subgroupElect();
    // Only the elected lane adds more than 0, as in trace_list.comp.
    uint first = subgroupBroadcastFirst(atomicAdd(start_arguments.count, is_first ? listed : 0u));
    if (is_first && listed > 0u) atomicMax(start_arguments.x, (first + listed + kPixelsPerListGroup - 1u) / kPixelsPerListGroup);
    if (is_listed) start_list[first + before] = place;
}

// Where work is counted, the first work group lists all starts in order (trace_list.comp says why).
void main() {
    if (count_work == 0u) {
        list_starts_of_group(gl_WorkGroupID.x);
        return;
    }
    if (any(notEqual(gl_WorkGroupID, uvec3(0)))) return;
    for (uint group = 0u; group < gl_NumWorkGroups.x; ++group) {
        list_starts_of_group(group);
        barrier();
    }
}
