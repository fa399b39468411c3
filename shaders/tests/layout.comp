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
layout(set = 0, binding = 12, scalar) readonly buffer Grids { LightProbeGrid grids[2]; };
layout(set = 0, binding = 13, scalar) readonly buffer Extents { LampExtent extents[2]; };
layout(set = 0, binding = 9, scalar) writeonly buffer Words { uint words[]; };

uint next = 0u;
void append_result_word(uint word) { words[next++] = word; }
void append_result_word(float number) { append_result_word(floatBitsToUint(number)); }
void append_result_word(vec2 v) { append_result_word(v.x), append_result_word(v.y); }
void append_result_word(uvec2 v) { append_result_word(v.x), append_result_word(v.y); }
void append_result_word(vec3 v) { append_result_word(v.x), append_result_word(v.y), append_result_word(v.z); }
void append_result_word(vec4 v) { append_result_word(v.x), append_result_word(v.y), append_result_word(v.z), append_result_word(v.w); }
void append_result_word(Surface s) {
    append_result_word(s.albedo), append_result_word(s.emission), append_result_word(s.reflectance), append_result_word(s.mirror), append_result_word(s.detail), append_result_word(s.centre),
        append_result_word(s.radius);
}

void main() {
    append_result_word(vertices[1].position), append_result_word(vertices[1].normal);
    append_result_word(surfaces[1]);
    Light l = lights[1];
    append_result_word(l.position), append_result_word(l.normal), append_result_word(l.intensity), append_result_word(l.right), append_result_word(l.down), append_result_word(l.forward),
        append_result_word(l.near);
    append_result_word(l.reach), append_result_word(l.cos_outer), append_result_word(l.sharpness), append_result_word(l.kind);
    LampExtent e = extents[1];
    append_result_word(e.first), append_result_word(e.second), append_result_word(e.third), append_result_word(e.flat_normal);
    append_result_word(probes[1].centre), append_result_word(probes[1].sphere), append_result_word(probes[1].radius), append_result_word(probes[1].reflectance);
    append_result_word(probes[1].lowest), append_result_word(probes[1].highest), append_result_word(probes[1].kind), append_result_word(probes[1].holds);
    View v = views[1];
    append_result_word(v.eye), append_result_word(v.right), append_result_word(v.down), append_result_word(v.forward), append_result_word(v.near), append_result_word(v.eye_low),
        append_result_word(v.parallel), append_result_word(v.clip);
    append_result_word(grids[1].first), append_result_word(grids[1].step);
    append_result_word(grids[1].counts.x), append_result_word(grids[1].counts.y), append_result_word(grids[1].counts.z);
    Sky s = skies[1];
    append_result_word(s.size), append_result_word(s.scale), append_result_word(s.turn);
    for (int i = 0; i < 9; ++i) append_result_word(s.irradiance[i]);
    for (int i = 0; i < SKY_LEVEL_COUNT; ++i) append_result_word(s.level_first[i]);
    for (int i = 0; i < SKY_LEVEL_COUNT; ++i) append_result_word(s.level_width[i]);
    append_result_word(s.cell_first), append_result_word(s.cell_count), append_result_word(s.cell_threshold), append_result_word(s.cell_density);
    Frame f = frames[1];
    append_result_word(f.ambient), append_result_word(f.light_count), append_result_word(f.mirror_count), append_result_word(f.object_count), append_result_word(f.shadow_faces);
    append_result_word(draws[1].first_view), append_result_word(draws[1].ablated), append_result_word(draws[1].shown);
    Placement p = placements[1];
    append_result_word(p.x), append_result_word(p.y), append_result_word(p.z), append_result_word(p.centre), append_result_word(p.centre_low);
    TraceParameters t = traces[1];
    append_result_word(t.sample_offset), append_result_word(t.sample_index), append_result_word(t.sample_count), append_result_word(t.size), append_result_word(t.seed), append_result_word(t.path_count), append_result_word(t.first_group);
    Counters c = counters[1];
    append_result_word(c.primary_rays), append_result_word(c.mirror_rays), append_result_word(c.shadow_rays), append_result_word(c.longest_walk), append_result_word(c.exhausted);
    append_result_word(c.mirror_pixels), append_result_word(c.listed);
}
