// Traces the listed pixels from the camera as the ray tracer does and puts them in the search's place.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/ray_counts.glsl"
#include "reflect/hybrid.glsl"

layout(local_size_x = 64) in; // kListGroup
layout(set = 0, binding = PICTURE_BINDING, rgba32f) writeonly uniform image2D picture;
layout(set = 0, binding = LIST_BINDING, scalar) readonly buffer List { uint list[]; };
layout(push_constant, scalar) uniform Push { uvec2 size; };

void main() {
    uint place = work_group() * kListGroup + gl_LocalInvocationIndex;
    bool inside = place < counters.value.listed;
    if (inside) {
        uvec2 pixel = uvec2(list[place] % size.x, list[place] / size.x);
        uint met;
        vec3 colour = radiance(camera_ray(vec2(pixel) + 0.5, size), 0u, met);
        // Weight 1 for what was traced, 0 for what was found: nothing in between.
        imageStore(picture, ivec2(pixel), vec4(colour, 1));
    }
    count(inside);
}
