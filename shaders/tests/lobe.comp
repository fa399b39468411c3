// Shader of tests/gpu/lobe_test.cpp: draws points of sample patterns and directions of lobes. Each invocation handles
// one sample.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/math.glsl"

layout(local_size_x = 64) in;
// Direction to the eye, roughness.
layout(set = 0, binding = 6, std430) readonly buffer Asked { vec4 asked[]; };
// Two elements a sample: drawn direction, weight; density, lobe, u, v.
layout(set = 0, binding = 7, std430) writeonly buffer Answers { vec4 answers[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 to_eye = asked[i].xyz;
    float alpha = roughness_to_alpha(asked[i].w), u, v;
    sample_pattern_point(i % 97u, i, i % 5u, 7u, u, v);
    vec3 to_light = sample_lobe(alpha, to_eye, u, v);
    answers[2u * i] = vec4(to_light, lobe_sample_weight(alpha, vec3(0.5), vec3(1), to_eye, to_light).x);
    answers[2u * i + 1u] = vec4(lobe_pdf(alpha, to_eye, to_light),
                                evaluate_lobe(alpha, vec3(0.5), vec3(1), to_eye, to_light).x, u, v);
}
