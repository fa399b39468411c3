// Shader of tests/gpu/layout_test.cpp: writes all members of the second array element of each structure of shared.h,
// word by word in order of declaration.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared.h"

layout(local_size_x = 1) in;
layout(set = 0, binding = 0, scalar) readonly buffer Vertices { Vertex vertices[2]; };
layout(set = 0, binding = 1, scalar) readonly buffer Surfaces { Surface surfaces[2]; };
layout(set = 0, binding = 2, scalar) readonly buffer Lights { Light lights[2]; };
layout(set = 0, binding = 3, scalar) readonly buffer Probes { Probe probes[2]; };
layout(set = 0, binding = 4, scalar) readonly buffer Views { View views[2]; };
layout(set = 0, binding = 5, scalar) readonly buffer Frames { Frame frames[2]; };
layout(set = 0, binding = 6, scalar) readonly buffer Draws { DrawParameters draws[2]; };
layout(set = 0, binding = 11, scalar) readonly buffer Placements { Placement placements[2]; };
layout(set = 0, binding = 7, scalar) readonly buffer Traces { TraceParameters traces[2]; };
layout(set = 0, binding = 8, scalar) readonly buffer AllCounters { Counters counters[2]; };
layout(set = 0, binding = 10, scalar) readonly buffer Skies { Sky skies[2]; };
layout(set = 0, binding = 9, scalar) writeonly buffer Words { uint words[]; };

uint next = 0u;
void put(uint word) { words[next++] = word; }
void put(float number) { put(floatBitsToUint(number)); }
void put(vec2 v) { put(v.x), put(v.y); }
void put(uvec2 v) { put(v.x), put(v.y); }
void put(vec3 v) { put(v.x), put(v.y), put(v.z); }
void put(vec4 v) { put(v.x), put(v.y), put(v.z), put(v.w); }
void put(Surface s) {
    put(s.albedo), put(s.emission), put(s.reflectance), put(s.mirror), put(s.detail), put(s.centre), put(s.radius);
}

void main() {
    put(vertices[1].position), put(vertices[1].normal);
    put(surfaces[1]);
    Light l = lights[1];
    put(l.position), put(l.normal), put(l.intensity), put(l.right), put(l.down), put(l.forward), put(l.near);
    put(l.reach), put(l.cos_outer), put(l.sharpness), put(l.kind);
    put(probes[1].centre), put(probes[1].sphere), put(probes[1].radius), put(probes[1].reflectance);
    put(probes[1].lowest), put(probes[1].highest), put(probes[1].kind);
    View v = views[1];
    put(v.eye), put(v.right), put(v.down), put(v.forward), put(v.near), put(v.eye_low), put(v.parallel), put(v.clip);
    Sky s = skies[1];
    put(s.size), put(s.scale), put(s.turn);
    for (int i = 0; i < 9; ++i) put(s.irradiance[i]);
    Frame f = frames[1];
    put(f.ambient), put(f.light_count), put(f.mirror_count), put(f.object_count), put(f.shadow_faces);
    put(draws[1].first_view), put(draws[1].ablated);
    Placement p = placements[1];
    put(p.x), put(p.y), put(p.z), put(p.centre), put(p.centre_low);
    TraceParameters t = traces[1];
    put(t.sample_offset), put(t.sample_index), put(t.sample_count), put(t.size), put(t.seed);
    Counters c = counters[1];
    put(c.primary_rays), put(c.mirror_rays), put(c.shadow_rays), put(c.longest_walk), put(c.exhausted);
    put(c.mirror_pixels), put(c.listed);
}
