// Shader of tests/gpu/timer_test.cpp and loop_limit_test.cpp: every invocation counts `turns` iterations of a loop. The
// first invocation of each work group writes its count.
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer Counts { uint counts[]; };
layout(push_constant) uniform Push { uint turns; };

void main() {
    uint count = 0u;
    uint hash = gl_GlobalInvocationID.x + 1u;
    for (uint i = 0u; i < turns; ++i) {
        // The hash is a permutation of all words that maps only 0 to 0. The hash is therefore never 0, but the compiler
        // cannot know and must keep the loop.
        hash = (hash ^ (hash >> 15)) * 2246822519u;
        count += hash == 0u ? 2u : 1u;
    }
    if (gl_LocalInvocationID.x == 0u) counts[gl_WorkGroupID.x] = count;
}
