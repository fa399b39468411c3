// Shader of tests/gpu/previous_test.cpp: computes after = 3 * before + index + number, modulo 2^20, for each word.
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Before { uint before[]; };
layout(set = 0, binding = 1, std430) writeonly buffer After { uint after[]; };
layout(push_constant) uniform Push { uint number; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < after.length()) after[i] = (3u * before[i] + i + number) % 1048576u;
}
