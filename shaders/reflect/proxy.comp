// Box and sphere that stand for each mirror's surroundings, from its captured distances: one work group
// a mirror, kAcross x kAcross texels a face. A flat wall across an axis gives its exact place at any texel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/bindings.glsl"
#include "lib/constants.glsl"
#include "reflect/proxy.glsl"

layout(local_size_x = 256) in;
layout(set = 0, binding = 20) uniform sampler2DArray distance_faces;
layout(set = 0, binding = 21, scalar) writeonly buffer Proxies { Proxy proxies[]; };

layout(constant_id = STORED_UNIT_CONSTANT) const float stored_unit = 1.0;
// With unorm8 a stored 1 is the end of the range, whatever lies there.
layout(constant_id = OWN_CONSTANTS) const uint range_ends = 0u;
const uint kAcross = 64u;

shared vec3 lows[gl_WorkGroupSize.x];
shared vec3 highs[gl_WorkGroupSize.x];
shared vec2 sums[gl_WorkGroupSize.x]; // of solid angle times distance, and of solid angle

void main() {
    uint me = gl_LocalInvocationIndex, mirror = gl_WorkGroupID.x;
    uint face = uint(textureSize(distance_faces, 0).x);
    uint across = min(face, kAcross);
    vec3 low = vec3(kLargest), high = vec3(-kLargest);
    vec2 sum = vec2(0);
    for (uint i = me; i < 6u * across * across; i += gl_WorkGroupSize.x) {
        uvec2 cell = uvec2(i % across, i / across % across);
        uint side = i / (across * across);
        // The middle texel of the cell; no product overflows below 2^26 texels an edge.
        uvec2 texel = (cell * face + face / 2u) / across;
        float stored = texelFetch(distance_faces, ivec3(texel, 6u * mirror + side), 0).r;
        if (is_miss(stored) || (range_ends != 0u && stored >= 1.0)) continue;
        vec2 place = (vec2(texel) + 0.5) / float(face) * 2.0 - 1.0;
        vec3 direction = normalize(cube_direction(int(side), vec3(place, 1)));
        vec3 point = direction * (stored * stored_unit);
        low = min(low, point);
        high = max(high, point);
        float angle = pow(1.0 + dot(place, place), -1.5);
        sum += angle * vec2(stored * stored_unit, 1);
    }
    lows[me] = low, highs[me] = high, sums[me] = sum;
    barrier();
    for (uint half_count = gl_WorkGroupSize.x / 2u; half_count > 0u; half_count /= 2u) {
        if (me < half_count) {
            lows[me] = min(lows[me], lows[me + half_count]);
            highs[me] = max(highs[me], highs[me + half_count]);
            sums[me] += sums[me + half_count];
        }
        barrier();
    }
    if (me == 0u) proxies[mirror] = Proxy(lows[0], highs[0], sums[0].y > 0.0 ? sums[0].x / sums[0].y : 0.0);
}
