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
void append(uint word) { words[next++] = word; }
void append(float number) { append(floatBitsToUint(number)); }
void append(vec2 v) { append(v.x), append(v.y); }
void append(uvec2 v) { append(v.x), append(v.y); }
void append(vec3 v) { append(v.x), append(v.y), append(v.z); }
void append(vec4 v) { append(v.x), append(v.y), append(v.z), append(v.w); }
void append(Surface s) {
    append(s.albedo), append(s.emission), append(s.reflectance), append(s.mirror), append(s.detail), append(s.centre),
        append(s.radius);
}

void main() {
    append(vertices[1].position), append(vertices[1].normal);
    append(surfaces[1]);
    Light l = lights[1];
    append(l.position), append(l.normal), append(l.intensity), append(l.right), append(l.down), append(l.forward),
        append(l.near);
    append(l.reach), append(l.cos_outer), append(l.sharpness), append(l.kind);
    append(probes[1].centre), append(probes[1].sphere), append(probes[1].radius), append(probes[1].reflectance);
    append(probes[1].lowest), append(probes[1].highest), append(probes[1].kind);
    View v = views[1];
    append(v.eye), append(v.right), append(v.down), append(v.forward), append(v.near), append(v.eye_low),
        append(v.parallel), append(v.clip);
    Sky s = skies[1];
    append(s.size), append(s.scale), append(s.turn);
    for (int i = 0; i < 9; ++i) append(s.irradiance[i]);
    for (int i = 0; i < SKY_LEVEL_COUNT; ++i) append(s.level_first[i]);
    for (int i = 0; i < SKY_LEVEL_COUNT; ++i) append(s.level_width[i]);
    Frame f = frames[1];
    append(f.ambient), append(f.light_count), append(f.mirror_count), append(f.object_count), append(f.shadow_faces);
    append(draws[1].first_view), append(draws[1].ablated);
    Placement p = placements[1];
    append(p.x), append(p.y), append(p.z), append(p.centre), append(p.centre_low);
    TraceParameters t = traces[1];
    append(t.sample_offset), append(t.sample_index), append(t.sample_count), append(t.size), append(t.seed);
    Counters c = counters[1];
    append(c.primary_rays), append(c.mirror_rays), append(c.shadow_rays), append(c.longest_walk), append(c.exhausted);
    append(c.mirror_pixels), append(c.listed);
}
