// Whitted ray tracing: one sample of each pixel a dispatch.
// Builds, which combine: #listed traces the pixels of a list and leaves the others as they are; #shadow_map asks
// the raster world's shadow map instead of tracing; #doubles computes hit points in doubles. #naive is the plain form
// that the benchmark compares with (see lib/trace.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/ray_counts.glsl"
#include "lib/trace_list.glsl"

layout(set = 0, binding = PICTURE_BINDING, rgba32f) uniform image2D picture;
layout(push_constant, scalar) uniform Push { Trace trace; };

#ifdef LISTED

layout(local_size_x = 64) in; // kListGroup
layout(set = 0, binding = LIST_BINDING, scalar) readonly buffer List { uint list[]; };

bool has_pixel(out uvec2 pixel) {
    uint place = work_group() * kListGroup + gl_LocalInvocationIndex;
    if (place >= counters.value.listed) return false;
    pixel = uvec2(list[place] % trace.size.x, list[place] / trace.size.x);
    return true;
}

#else

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = PIXELS_IN_ROWS_CONSTANT) const uint pixels_in_rows = 0u;

// Eight that run together are a block of 4x2 pixels, or a row.
uvec2 place_in_group(uint i) {
    return pixels_in_rows != 0u ? uvec2(i & 7u, i >> 3) : uvec2(i & 3u | i >> 1 & 4u, i >> 2 & 1u | i >> 3 & 6u);
}

bool has_pixel(out uvec2 pixel) {
    uint across = (trace.size.x + 7u) / 8u;
    uint group = work_group();
    pixel = uvec2(group % across, group / across) * 8u + place_in_group(gl_LocalInvocationIndex);
    return all(lessThan(pixel, trace.size));
}

#endif

void main() {
    Trace asked = trace; // read before lanes go different ways
    uvec2 pixel;
    bool inside = has_pixel(pixel);
    if (inside) {
        uint met;
        vec3 sum = radiance(camera_ray(vec2(pixel) + asked.sample_offset, asked.size), 0u, met);
        vec4 before = vec4(vec3(0), uintBitsToFloat(met | kBvhTag)); // what is met goes where a picture has its alpha
        if (asked.sample_index > 0u) before = imageLoad(picture, ivec2(pixel));
        sum += before.rgb;
        if (asked.sample_index + 1u == asked.sample_count) sum /= float(asked.sample_count);
        imageStore(picture, ivec2(pixel), vec4(sum, before.a));
    }
    count(inside);
}
