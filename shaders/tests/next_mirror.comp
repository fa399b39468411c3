// Shader of tests/gpu/next_mirror_test.cpp: finds the first mirror on each ray, with or without the mirror tree. Each
// invocation handles one ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/next_mirror.glsl"

layout(local_size_x = 64) in;
// Two elements per ray: origin, end; direction, mirror to ignore.
layout(set = 0, binding = 6, std430) readonly buffer Rays { uvec4 rays[]; };
// First sphere (from 1), its t, whether a mirror is met before the end, 0.
layout(set = 0, binding = 7, std430) writeonly buffer Answers { uvec4 answers[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Ray ray = Ray(uintBitsToFloat(rays[2u * i].xyz), uintBitsToFloat(rays[2u * i + 1u].xyz), 0u);
    uint except = rays[2u * i + 1u].w, first;
    float end = uintBitsToFloat(rays[2u * i].w), t, met;
    uint sphere = find_first_exact_sphere(ray, except, first, t) ? first + 1u : 0u;
    bool before = mirror_tree != 0u ? find_first_mirror_by_tree(ray, except, false, first, met) && !(end < met)
                                    : intersects_mirror_before(ray, except, end);
    answers[i] = uvec4(sphere, sphere != 0u ? floatBitsToUint(t) : 0u, before ? 1u : 0u, 0u);
}
