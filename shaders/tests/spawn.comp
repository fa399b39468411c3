// Shader of tests/support/kernel.hpp: computes points on triangles, their normals, and origins of rays that leave them,
// as the ray tracer does. Each invocation computes one point. Buffers hold 32-bit words instead of floats.
#version 460
#extension GL_GOOGLE_include_directive : require
#define BVH_NODES_BINDING 0
#define BVH_TRIANGLES_BINDING 1
#include "lib/trace.glsl"

layout(local_size_x = TRACE_LOCAL_SIZE) in;
// Two elements per point: barycentric weights, stored triangle; direction, 0.
layout(set = 0, binding = 2, std430) readonly buffer Starts { uvec4 starts[]; };
// Three elements per point: point, 0; normal, 0; ray origin, 0.
layout(set = 0, binding = 3, std430) writeonly buffer Leavings { uvec4 leavings[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec3 a, b, c, error;
    read_triangle_corners(starts[2u * i].w, a, b, c);
    vec3 point = triangle_hit_point(a, b, c, uintBitsToFloat(starts[2u * i].xyz), error);
    vec3 facet = facet_normal(a, b, c);
    vec3 direction = uintBitsToFloat(starts[2u * i + 1u].xyz);
    vec3 origin = is_precision_rule_kept(kOriginErrorBoundRule) ? ray_spawn_origin(point, error, facet, direction)
        : plain_ray_spawn_origin(point, facet, direction);
    leavings[3u * i] = uvec4(floatBitsToUint(point), 0u);
    leavings[3u * i + 1u] = uvec4(floatBitsToUint(facet), 0u);
    leavings[3u * i + 2u] = uvec4(floatBitsToUint(origin), 0u);
}
