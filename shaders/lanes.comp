// Counts the lanes of a subgroup (session/lanes.cpp). A driver may compile a program for each subgroup width, with
// gl_SubgroupSize as a constant. Only a sum over the lanes tells which of these programs runs.
#version 460
#extension GL_KHR_shader_subgroup_arithmetic : require

layout(local_size_x = 128) in; // 128 invocations, because no device has wider subgroups
layout(set = 0, binding = 0, std430) buffer Lanes { uint lanes; };

void main() {
    uint count = subgroupAdd(1u);
    if (gl_LocalInvocationIndex == 0u) lanes = count;
}
