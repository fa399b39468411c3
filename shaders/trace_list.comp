// Lists the pixels that the view has left to one tracer: one append a subgroup, and one work group of its
// dispatch for each 64 of them.
// No branch lies before a subgroup operation: after one, nothing promises that the lanes run together again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"
#include "lib/trace_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = LOOKUP_BINDING, rgba32f) readonly uniform image2D lookup;
layout(set = 0, binding = MARKS_BINDING, r32f) readonly uniform image2D marks;
layout(set = 0, binding = COUNTERS_BINDING, scalar) buffer CountersBuffer { Counters value; } counters;
layout(set = 0, binding = LIST_BINDING, scalar) writeonly buffer List { uint list[]; };
layout(set = 0, binding = ARGUMENTS_BINDING, scalar) buffer Arguments { uvec3 groups; } arguments;
layout(push_constant, scalar) uniform Push { uvec2 size; };

layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;

uvec2 groups_for(uint pixels) {
    uint groups = (pixels + kListGroup - 1u) / kListGroup;
    return uvec2(min(groups, kListGroups), (groups + kListGroups - 1u) / kListGroups);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool inside = all(lessThan(pixel, size));
    ivec2 place = ivec2(min(pixel, size - 1u));
    // 0 where no tracer is to take over; a lookup of 0 where no mirror was looked up: see lib/surface.glsl.
    float mark = imageLoad(marks, place).r, looked_up = imageLoad(lookup, place).w;
    uint is_mirror = uint(inside) & (uint(mark != 0.0) | uint(looked_up != 0.0));
    uint is_listed = uint(inside) & uint(mark == float(tracer));
    uvec4 lanes = subgroupBallot(is_listed != 0u);
    uint mirrors = subgroupBallotBitCount(subgroupBallot(is_mirror != 0u));
    uint listed = subgroupBallotBitCount(lanes), before = subgroupBallotExclusiveBitCount(lanes);
    bool is_first = subgroupElect();
    // All lanes add, all but one nothing. The lane that adds is the one whose value is broadcast: of those that are
    // active that with the lowest number (SPIR-V, OpGroupNonUniformElect and OpGroupNonUniformBroadcastFirst).
    uint first = subgroupBroadcastFirst(atomicAdd(counters.value.listed, is_first ? listed : 0u));
    if (is_first && mirrors > 0u) atomicAdd(counters.value.mirror_pixels, mirrors);
    if (is_first && listed > 0u) {
        // What the list grows by, so that the sum over all subgroups is what the whole list needs.
        uvec2 more = groups_for(first + listed) - groups_for(first);
        if (more.x > 0u) atomicAdd(arguments.groups.x, more.x);
        if (more.y > 0u) atomicAdd(arguments.groups.y, more.y);
    }
    if (is_listed != 0u) list[first + before] = pixel.y * size.x + pixel.x;
    if (all(equal(pixel, uvec2(0)))) arguments.groups.z = 1u;
}
