// Lists the pixels that the camera's view marked for one ray tracer. Counts the work groups of the tracer's dispatch,
// one for each 64 pixels. A subgroup appends all of its pixels to the list at once.
// #first reads the marks in the alpha of the view's colour (lib/first_hit.glsl).
// No branch precedes a subgroup operation, because after a branch the lanes need not run together again.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"
#include "lib/first_hit.glsl"
#include "lib/trace_list.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = PICTURE_BINDING, rgba32f) readonly uniform image2D picture;
#ifndef FIRST_HIT
layout(set = 0, binding = LOOKUP_BINDING, rgba32f) readonly uniform image2D lookup;
layout(set = 0, binding = MARKS_BINDING, r32f) readonly uniform image2D marks;
#endif
layout(set = 0, binding = COUNTERS_BINDING, scalar) buffer CountersBuffer { Counters value; } counters;
layout(set = 0, binding = LIST_BINDING, scalar) writeonly buffer List { uint list[]; };
layout(set = 0, binding = ARGUMENTS_BINDING, scalar) buffer Arguments { uvec3 groups; } arguments;
layout(push_constant, scalar) uniform Push { uvec2 size; };

layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;
layout(constant_id = FIRST_RASTER_CONSTANT) const uint first_raster = 0u;

uvec2 count_groups(uint pixels) {
    uint groups = (pixels + kPixelsPerListGroup - 1u) / kPixelsPerListGroup;
    return uvec2(min(groups, kMaxListGroupsPerRow), (groups + kMaxListGroupsPerRow - 1u) / kMaxListGroupsPerRow);
}

// Lists the pixels of one 8x8 block that the tracer takes.
void list_pixels_of_block(uvec2 pixel) {
    bool inside = all(lessThan(pixel, size));
    ivec2 place = ivec2(min(pixel, size - 1u));
#ifdef FIRST_HIT
    vec4 words = imageLoad(picture, place);
    uint is_mirror = uint(inside) & uint(is_first_hit_on_mirror(words));
    uint is_listed = uint(inside) & uint(is_first_hit_for_tracer(words, tracer));
#else
    // `mark` is the number of the tracer that takes the pixel, or 0. `looked_up` is 0 where no mirror
    // looked its reflection up in a capture (lib/surface.glsl).
    float mark = imageLoad(marks, place).r, looked_up = imageLoad(lookup, place).w;
    uint is_mirror = uint(inside) & (uint(mark != 0.0) | uint(looked_up != 0.0));
    uint is_listed = uint(inside) & uint(mark == float(tracer));
#endif
    uvec4 lanes = subgroupBallot(is_listed != 0u);
    uint mirrors = subgroupBallotBitCount(subgroupBallot(is_mirror != 0u));
    uint listed = subgroupBallotBitCount(lanes), before = subgroupBallotExclusiveBitCount(lanes);
    bool is_first = subgroupElect();
    // All lanes execute the atomic addition, but only the elected lane adds more than 0. The broadcast takes the result
    // of the same lane: SPIR-V's OpGroupNonUniformElect and OpGroupNonUniformBroadcastFirst both choose the active lane
    // with the lowest number.
    uint first = subgroupBroadcastFirst(atomicAdd(counters.value.listed, is_first ? listed : 0u));
    if (is_first && mirrors > 0u) atomicAdd(counters.value.mirror_pixels, mirrors);
    if (is_first && listed > 0u) {
        // Adds the work groups that the list needs beyond those of the pixels listed before. The sum over all subgroups
        // is the number of work groups for the whole list.
        uvec2 more = count_groups(first + listed) - count_groups(first);
        if (more.x > 0u) atomicAdd(arguments.groups.x, more.x);
        if (more.y > 0u) atomicAdd(arguments.groups.y, more.y);
    }
    if (is_listed != 0u) {
        uint entry = words_per_list_entry(first_raster) * (first + before);
        list[entry] = pixel.y * size.x + pixel.x;
        if (first_raster != 0u) {
            vec4 met = imageLoad(picture, place);
            list[entry + 1u] = floatBitsToUint(met.x);
            list[entry + 2u] = floatBitsToUint(met.y);
        }
    }
    if (all(equal(pixel, uvec2(0)))) arguments.groups.z = 1u;
}

// Blocks are listed in the order in which work groups come by. Which pixels are traced together, and thereby the number
// of live lanes, differs from run to run. Where work is counted, the first work group lists all blocks in order.
void main() {
    if (count_work == 0u) {
        list_pixels_of_block(gl_GlobalInvocationID.xy);
        return;
    }
    if (any(notEqual(gl_WorkGroupID, uvec3(0)))) return;
    for (uint block = 0u; block < gl_NumWorkGroups.x * gl_NumWorkGroups.y; ++block) {
        list_pixels_of_block(8u * uvec2(block % gl_NumWorkGroups.x, block / gl_NumWorkGroups.x) + gl_LocalInvocationID.xy);
        barrier();
    }
}
