// Whitted ray tracing. One dispatch traces one sample of each pixel.
// The shader has these variants, which combine. #listed traces only the pixels of a list and keeps all other pixels.
// #doubles computes hit points in double precision.
// #shared traces the paths of a sample in several dispatches, which share the camera ray (lib/path_start.glsl).
// #naive is the simple implementation that a benchmark compares with (lib/trace.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/trace_list.glsl"
#ifdef SHARES_CAMERA_RAYS
#include "lib/constants.glsl"
#include "shared.h"
layout(set = 0, binding = STARTS_BINDING, scalar) buffer Starts { PathStart starts[]; };
layout(set = 0, binding = START_LIST_BINDING, scalar) readonly buffer StartList { uint start_list[]; };
layout(set = 0, binding = START_ARGUMENTS_BINDING, scalar) buffer StartArguments { PathStartArguments start_arguments; };
layout(constant_id = RESUMES_PATHS_CONSTANT) const uint resumes_paths = 0u; // 1: traces paths from stored starts; 0: the shared part
#endif
#include "lib/ray_counts.glsl"

layout(set = 0, binding = PICTURE_BINDING, rgba32f) uniform image2D picture;
layout(push_constant, scalar) uniform Push { TraceParameters trace; };

#ifdef LISTED

layout(local_size_x = 64) in; // 64 invocations: kPixelsPerListGroup
layout(set = 0, binding = LIST_BINDING, scalar) readonly buffer List { uint list[]; };

bool find_pixel_to_trace(uint place, out uvec2 pixel) {
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

bool find_pixel_to_trace(uint place, out uvec2 pixel) {
    uint across = (trace.size.x + 7u) / 8u, group = place / kPixelsPerListGroup;
    pixel = uvec2(group % across, group / across) * 8u + pixel_in_work_group(gl_LocalInvocationIndex);
    return all(lessThan(pixel, trace.size));
}

#endif

#ifdef SHARES_CAMERA_RAYS

void choose_path_start(uint place) {
    start_place = place % kMaxPathStarts;
    // The next dispatch lists the starts.
    if (finds_path_start && start_place == 0u) start_arguments = PathStartArguments(0u, 1u, 1u, 0u);
}

// Finds the pixel whose path this invocation resumes.
bool find_pixel_to_resume(uint place, out uvec2 pixel) {
    if (place >= start_arguments.count) return false;
    start_place = start_list[place];
    uint number = starts[start_place].pixel;
    pixel = uvec2(number % trace.size.x, number / trace.size.x);
    return true;
}

#else

void choose_path_start(uint place) {}
bool find_pixel_to_resume(uint place, out uvec2 pixel) { return false; }

#endif

void main() {
    TraceParameters asked = trace; // push constants are read before the lanes diverge
    uint place = (asked.first_group + find_assigned_work_group()) * kPixelsPerListGroup + gl_LocalInvocationIndex;
    choose_path_start(place);
    uvec2 pixel;
    bool inside = resumes_path ? find_pixel_to_resume(place, pixel) : find_pixel_to_trace(place, pixel);
    if (inside) {
#ifdef LISTED
        occluded_pixel = ivec2(pixel);
#endif
        if (traces_lobes != 0u || environment_shadows != 0u) {
            path_pixel = pixel.y * asked.size.x + pixel.x;
            path_sample = asked.sample_index;
            path_seed = asked.seed;
        }
        if (resumes_path) met_before = floatBitsToUint(imageLoad(picture, ivec2(pixel)).a) & ~kBvhNormalFloatBit;
        uint met;
        Ray ray = make_camera_ray(vec2(pixel) + asked.sample_offset, asked.size);
        vec3 sum = trace_radiance(ray, 0u, met);
        if (finds_path_start) store_end_of_shared_part(ray, sum, met);
        if (resumes_path) sum /= float(asked.path_count);
        vec4 before = vec4(0);
        if (resumes_path || asked.sample_index > 0u) before = imageLoad(picture, ivec2(pixel));
        // The picture's alpha holds the numbers of the mirrors that the ray of the first sample meets.
        if (asked.sample_index == 0u) before.a = uintBitsToFloat(met | kBvhNormalFloatBit);
        sum += before.rgb;
        uint traced = asked.sample_index + (finds_path_start ? asked.path_count : 1u);
        if (traced == asked.sample_count && !has_path_start()) sum /= float(asked.sample_count / asked.path_count);
        imageStore(picture, ivec2(pixel), vec4(sum, before.a));
    } else if (finds_path_start) {
        store_no_path_start();
    }
    count_rays();
}
