// Whitted ray tracing: one sample of each pixel a dispatch.
// Builds: default; #shadow_map asks the raster world's shadow map instead of tracing; #doubles and
// #shadow_map_doubles compute hit points in doubles; #naive is the
// plain form that the benchmark compares with (see lib/trace.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/ray_counts.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = PICTURE_BINDING, rgba32f) uniform image2D picture;
layout(set = 0, binding = HITS_BINDING, r32ui) writeonly uniform uimage2D hits;
layout(push_constant, scalar) uniform Push { Trace trace; };

void main() {
    uint across = (trace.size.x + 7u) / 8u;
    uint group = work_group();
    uvec2 pixel = uvec2(group % across, group / across) * 8u + gl_LocalInvocationID.xy;
    bool inside = all(lessThan(pixel, trace.size));
    if (inside) {
        uint met;
        vec3 sum = radiance(camera_ray(vec2(pixel) + trace.sample_offset, trace.size), 0u, met);
        if (trace.sample_index == 0u)
            imageStore(hits, ivec2(pixel), uvec4(met));
        else
            sum += imageLoad(picture, ivec2(pixel)).rgb;
        if (trace.sample_index + 1u == trace.sample_count) sum /= float(trace.sample_count);
        imageStore(picture, ivec2(pixel), vec4(sum, 1));
    }
    count(inside);
}
