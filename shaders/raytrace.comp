// Whitted ray tracing. One dispatch traces one sample of each pixel.
// The shader has these variants, which combine. #listed traces only the pixels of a list and keeps all other pixels.
// #doubles computes hit points in double precision.
// #naive is the simple implementation that a benchmark compares with (lib/trace.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/ray_counts.glsl"
#include "lib/trace_list.glsl"

layout(set = 0, binding = PICTURE_BINDING, rgba32f) uniform image2D picture;
layout(push_constant, scalar) uniform Push { TraceParameters trace; };

#ifdef LISTED

layout(local_size_x = 64) in; // 64 invocations: kPixelsPerListGroup
layout(set = 0, binding = LIST_BINDING, scalar) readonly buffer List { uint list[]; };

bool find_pixel_to_trace(out uvec2 pixel) {
    uint place = (trace.first_group + find_assigned_work_group()) * kPixelsPerListGroup + gl_LocalInvocationIndex;
    if (place >= counters.value.listed) return false;
    uint entry = words_per_list_entry(first_raster) * place;
    pixel = uvec2(list[entry] % trace.size.x, list[entry] / trace.size.x);
    if (first_raster != 0u) first_words = vec4(uintBitsToFloat(list[entry + 1u]), uintBitsToFloat(list[entry + 2u]), 0, -1);
    return true;
}

#else

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = PIXELS_IN_ROWS_CONSTANT) const uint pixels_in_rows = 0u;

// Maps invocation `i` of a work group to its pixel: each eight invocations take a block of 4x2 pixels, or a row of 8.
uvec2 pixel_in_work_group(uint i) {
    return pixels_in_rows != 0u ? uvec2(i & 7u, i >> 3) : uvec2(i & 3u | i >> 1 & 4u, i >> 2 & 1u | i >> 3 & 6u);
}

bool find_pixel_to_trace(out uvec2 pixel) {
    uint across = (trace.size.x + 7u) / 8u;
    uint group = trace.first_group + find_assigned_work_group();
    pixel = uvec2(group % across, group / across) * 8u + pixel_in_work_group(gl_LocalInvocationIndex);
    return all(lessThan(pixel, trace.size));
}

#endif

void main() {
    TraceParameters asked = trace; // push constants are read before the lanes diverge
    uvec2 pixel;
    bool inside = find_pixel_to_trace(pixel);
    if (inside) {
        uint met;
#ifdef LISTED
        occluded_pixel = ivec2(pixel);
#endif
        if (traces_lobes != 0u || environment_shadows != 0u) {
            path_pixel = pixel.y * asked.size.x + pixel.x;
            path_sample = asked.sample_index;
            path_seed = asked.seed;
        }
        vec3 sum = trace_radiance(make_camera_ray(vec2(pixel) + asked.sample_offset, asked.size), 0u, met);
        // The picture's alpha holds the numbers of the mirrors that the ray of the first sample meets.
        vec4 before = vec4(vec3(0), uintBitsToFloat(met | kBvhNormalFloatBit));
        if (asked.sample_index > 0u) before = imageLoad(picture, ivec2(pixel));
        sum += before.rgb;
        if (asked.sample_index + 1u == asked.sample_count) sum /= float(asked.sample_count);
        imageStore(picture, ivec2(pixel), vec4(sum, before.a));
    }
    count_rays();
}
