// Counts the lanes that run together (app/lanes.cpp). A driver that compiles gl_SubgroupSize as a constant gives two
// widths two programs, so that only a sum over the lanes tells which of them runs.
#version 460
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(local_size_x = 128) in; // no device has wider subgroups
layout(set = 0, binding = 0, std430) buffer Lanes { uint lanes; };

void main() {
    uint count = subgroupAdd(1u);
    if (gl_LocalInvocationIndex == 0u) lanes = count;
}
