// Traces rays from a buffer with the device's own ray query, one ray per invocation (tests/drivers/ray_query.hpp).
// Rays and hits have the layout that kernel.comp uses.
#version 460
#extension GL_EXT_ray_query : require

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT triangles;
layout(set = 0, binding = 1, std430) readonly buffer Rays { uvec4 rays[]; };  // origin, t_max; direction, leaves
layout(set = 0, binding = 2, std430) writeonly buffer Hits { uvec4 hits[]; }; // t, weights; triangle, object, outcome, steps
layout(push_constant) uniform Push { uint count; };

const uint kFoundHitBit = 1u; // value of `outcome` if the ray hits a triangle

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uvec4 from = rays[2u * i];
    uvec4 along = rays[2u * i + 1u];
    rayQueryEXT query;
    rayQueryInitializeEXT(query, triangles, gl_RayFlagsOpaqueEXT, 0xffu, uintBitsToFloat(from.xyz), 0.0,
                          uintBitsToFloat(along.xyz), uintBitsToFloat(from.w));
    while (rayQueryProceedEXT(query)) {}
    hits[2u * i] = uvec4(0);
    hits[2u * i + 1u] = uvec4(0);
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionTriangleEXT) return;
    vec2 weights = rayQueryGetIntersectionBarycentricsEXT(query, true); // weights of the corners b and c
    vec4 hit = vec4(rayQueryGetIntersectionTEXT(query, true), 1.0 - weights.x - weights.y, weights);
    hits[2u * i] = floatBitsToUint(hit);
    hits[2u * i + 1u] = uvec4(rayQueryGetIntersectionPrimitiveIndexEXT(query, true), 0u, kFoundHitBit, 0u);
}
