// Lists the pixels that the view has left to one tracer: one append a subgroup, and one work group of its
// dispatch for each 64 of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
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
    // 0 where no tracer is to take over; a lookup of 0 where no mirror was looked up: see lib/surface.glsl.
    float mark = inside ? imageLoad(marks, ivec2(pixel)).r : 0.0;
    bool is_mirror = inside && (mark != 0.0 || imageLoad(lookup, ivec2(pixel)).w != 0.0);
    bool is_listed = mark == float(tracer);
    uint mirrors = subgroupAdd(is_mirror ? 1u : 0u);
    uint listed = subgroupAdd(is_listed ? 1u : 0u);
    uint before = subgroupExclusiveAdd(is_listed ? 1u : 0u);
    uint first = 0u;
    if (subgroupElect() && mirrors > 0u) {
        atomicAdd(counters.value.mirror_pixels, mirrors);
        if (listed > 0u) {
            first = atomicAdd(counters.value.listed, listed);
            // What the list grows by, so that the sum over all subgroups is what the whole list needs.
            uvec2 more = groups_for(first + listed) - groups_for(first);
            if (more.x > 0u) atomicAdd(arguments.groups.x, more.x);
            if (more.y > 0u) atomicAdd(arguments.groups.y, more.y);
        }
    }
    first = subgroupMax(first); // of the one elected
    if (is_listed) list[first + before] = pixel.y * size.x + pixel.x;
    if (all(equal(pixel, uvec2(0)))) arguments.groups.z = 1u;
}
