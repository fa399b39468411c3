// Writes what the camera ray through each pixel's centre meets first: distance, normal, object and roughness. The ray is
// the one that raytrace.comp traces for one sample in a pixel, with the triangles of all spheres.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/ray_counts.glsl"

layout(set = 0, binding = PICTURE_BINDING, rgba32f) writeonly uniform image2D normals_and_distances;
// The object's number from 1 as a word of engine/bvh/words.hpp, and the texture's factor of the material's roughness.
layout(set = 0, binding = 20, rgba32f) writeonly uniform image2D objects_and_roughness;
layout(push_constant, scalar) uniform Push {
    uvec2 size;
    uint first_group; // of this dispatch, which may be a range of all
};

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
    uvec2 picture_size = size; // push constants are read before the lanes diverge
    uint across = (picture_size.x + 7u) / 8u, group = first_group + find_assigned_work_group();
    uvec2 pixel = uvec2(group % across, group / across) * 8u + uvec2(gl_LocalInvocationIndex & 7u, gl_LocalInvocationIndex >> 3);
    if (all(lessThan(pixel, picture_size))) {
        vec4 normal_and_distance = vec4(0);
        uint number = 0u;
        float factor = 1.0;
        Ray ray = make_camera_ray(vec2(pixel) + 0.5, picture_size);
        TraceHit hit;
        ++camera_rays;
        bool found = find_closest_hit(ray, kLargestFloat, kBvhHiddenFromCamera | kBvhOneSided | skipped_triangle_flags(), hit);
        trace_low = vec3(0);
        if (found) {
            point = point_on_triangle(hit);
            evaluate_surface(point, ray.direction);
            uint detail = read_surface(point.object).detail;
            if (details != 0u) factor = sample_texture(read_material_parameters(detail).rough, point.at.uv).g;
            normal_and_distance = vec4(point.normal, hit.t);
            number = point.object + 1u;
        }
        imageStore(normals_and_distances, ivec2(pixel), normal_and_distance);
        imageStore(objects_and_roughness, ivec2(pixel), vec4(uintBitsToFloat(number | kBvhNormalFloatBit), factor, 0, 0));
    }
    count_rays();
}
