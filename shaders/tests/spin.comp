// tests/gpu/timer_test.cpp and loop_limit_test.cpp: counts `turns` turns of a loop in every invocation;
// the first of each work group tells its count.
#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) writeonly buffer Counts { uint counts[]; };
layout(push_constant) uniform Push { uint turns; };

void main() {
    uint count = 0u;
    uint hash = gl_GlobalInvocationID.x + 1u;
    for (uint i = 0u; i < turns; ++i) {
        // A permutation of the words that leaves only 0 in place: never 0, but no compiler knows.
        hash = (hash ^ (hash >> 15)) * 2246822519u;
        count += hash == 0u ? 2u : 1u;
    }
    if (gl_LocalInvocationID.x == 0u) counts[gl_WorkGroupID.x] = count;
}
