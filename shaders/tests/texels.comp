// Shader of tests/gpu/texels_test.cpp: reads one element of each structure in a texel list, and writes all members,
// word by word in order of declaration.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/material.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 50, scalar) writeonly buffer Words { uint words[]; };
layout(push_constant) uniform Push { uint number; };

uint next = 0u;
void append(uint word) { words[next++] = word; }
void append(float number) { append(floatBitsToUint(number)); }
void append(vec3 v) { append(v.x), append(v.y), append(v.z); }
void append(vec4 v) { append(v.x), append(v.y), append(v.z), append(v.w); }
void append(TextureUse use) {
    append(use.first), append(use.size), append(use.how), append(use.u_row), append(use.v_row);
}

void main() {
    Surface s = read_surface(number);
    append(s.albedo), append(s.emission), append(s.reflectance), append(s.mirror), append(s.detail), append(s.centre),
        append(s.radius);
    Probe p = probe_at(number);
    append(p.centre), append(p.sphere), append(p.radius), append(p.reflectance), append(p.lowest), append(p.highest),
        append(p.kind);
    MaterialParameters d = read_material_parameters(number);
    append(d.flags), append(d.first_attribute), append(d.max_specular_roughness), append(d.alpha),
        append(d.alpha_cutoff);
    append(d.f0), append(d.f90), append(d.albedo), append(d.emission), append(d.rough), append(d.normal), append(d.normal_scale);
    append(d.absorption), append(d.ior);
#define PUT_FACTOR(name) append(d.name);
    MATERIAL_FACTORS(PUT_FACTOR)
    VertexAttribute a = read_vertex_attribute(number);
    append(a.uv), append(a.colour);
    append(texture_words_at(number));
}
