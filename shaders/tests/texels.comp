// Shader of tests/gpu/texels_test.cpp: reads one element of each structure in a texel list, and writes all members,
// word by word in order of declaration.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/material.glsl"

layout(local_size_x = 1) in;
layout(set = 0, binding = 50, scalar) writeonly buffer Words { uint words[]; };
layout(push_constant) uniform Push { uint number; };

uint next = 0u;
void put(uint word) { words[next++] = word; }
void put(float number) { put(floatBitsToUint(number)); }
void put(vec3 v) { put(v.x), put(v.y), put(v.z); }
void put(vec4 v) { put(v.x), put(v.y), put(v.z), put(v.w); }
void put(TextureUse use) { put(use.first), put(use.size), put(use.how), put(use.u_row), put(use.v_row); }

void main() {
    Surface s = read_surface(number);
    put(s.albedo), put(s.emission), put(s.reflectance), put(s.mirror), put(s.detail), put(s.centre), put(s.radius);
    Probe p = probe_at(number);
    put(p.centre), put(p.sphere), put(p.radius), put(p.reflectance), put(p.lowest), put(p.highest), put(p.kind);
    MaterialParameters d = read_material_parameters(number);
    put(d.flags), put(d.first_attribute), put(d.max_specular_roughness), put(d.alpha), put(d.alpha_cutoff);
    put(d.f0), put(d.f90), put(d.albedo), put(d.emission), put(d.rough);
#define PUT_FACTOR(name) put(d.name);
    MATERIAL_FACTORS(PUT_FACTOR)
    VertexAttribute a = read_vertex_attribute(number);
    put(a.uv), put(a.colour);
    put(texture_words_at(number));
}
