// Shader of tests/gpu/texels_test.cpp: reads one element of each structure in a texel list, and writes all members,
// word by word in order of declaration.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/material.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 50, scalar) writeonly buffer Words { uint words[]; };
layout(push_constant) uniform Push { uint number; };

uint next = 0u;
void append_result_word(uint word) { words[next++] = word; }
void append_result_word(float number) { append_result_word(floatBitsToUint(number)); }
void append_result_word(vec3 v) { append_result_word(v.x), append_result_word(v.y), append_result_word(v.z); }
void append_result_word(vec4 v) { append_result_word(v.x), append_result_word(v.y), append_result_word(v.z), append_result_word(v.w); }
void append_result_word(TextureUse use) {
    append_result_word(use.first), append_result_word(use.size), append_result_word(use.how), append_result_word(use.u_row), append_result_word(use.v_row);
}

void main() {
    Surface s = read_surface(number);
    append_result_word(s.albedo), append_result_word(s.emission), append_result_word(s.reflectance), append_result_word(s.mirror), append_result_word(s.detail), append_result_word(s.centre),
        append_result_word(s.radius);
    Probe p = read_probe(number);
    append_result_word(p.centre), append_result_word(p.sphere), append_result_word(p.radius), append_result_word(p.reflectance), append_result_word(p.lowest), append_result_word(p.highest),
        append_result_word(p.kind), append_result_word(p.holds);
    MaterialParameters d = read_material_parameters(number);
    append_result_word(d.flags), append_result_word(d.first_attribute), append_result_word(d.max_specular_roughness), append_result_word(d.alpha),
        append_result_word(d.alpha_cutoff);
    append_result_word(d.f0), append_result_word(d.f90), append_result_word(d.albedo), append_result_word(d.emission), append_result_word(d.rough), append_result_word(d.normal), append_result_word(d.normal_scale);
    append_result_word(d.absorption), append_result_word(d.ior);
#define PUT_FACTOR(name, extension, key, gltf_default, largest) append_result_word(d.name);
    MATERIAL_FACTORS(PUT_FACTOR)
    VertexAttribute a = read_vertex_attribute(number);
    append_result_word(a.uv), append_result_word(a.colour);
    append_result_word(texture_words_at(number));
}
