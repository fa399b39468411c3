// Computes the box and the sphere that approximate each mirror's surroundings, from the captured distances. Each work
// group handles one mirror and reads kMaxTexelsAcross x kMaxTexelsAcross texels of each face. This sampling is exact
// for a flat wall perpendicular to an axis, since any texel of such a wall gives the wall's position.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/captures.glsl"
#include "reflect/proxy.glsl"

layout(local_size_x = 256) in;
layout(set = 0, binding = 20) uniform FACES(distance_faces);
layout(set = 0, binding = 21, scalar) writeonly buffer Proxies { ProxyShapes proxies[]; };

const uint kMaxTexelsAcross = 64u;

shared vec3 lows[gl_WorkGroupSize.x];
shared vec3 highs[gl_WorkGroupSize.x];
shared vec2 sums[gl_WorkGroupSize.x]; // sum of solid angle times distance, and sum of solid angle

int captured_face_edge(uint mirror) {
#define FACE_EDGE(i) textureSize(FACES_OF(distance_faces, i), 0).x
    RETURN_OF_ARRAY(mirror, FACE_EDGE)
}
float read_stored_distance(uint mirror, ivec3 texel) {
#define STORED_AT(i) texelFetch(FACES_OF(distance_faces, i), texel, 0).r
    count_work_once(kWorkDistanceLookups);
    RETURN_OF_ARRAY(mirror, STORED_AT)
}

void main() {
    uint me = gl_LocalInvocationIndex, mirror = gl_WorkGroupID.x;
    uint face = uint(captured_face_edge(mirror));
    uint across = min(face, kMaxTexelsAcross);
    vec3 low = vec3(kLargestFloat), high = vec3(-kLargestFloat);
    vec2 sum = vec2(0);
    for (uint i = me; i < 6u * across * across; i += gl_WorkGroupSize.x) {
        uvec2 cell = uvec2(i % across, i / across % across);
        uint side = i / (across * across);
        // The middle texel of the sampled cell. No product overflows if a face's edge has fewer than 2^26 texels.
        uvec2 texel = (cell * face + face / 2u) / across;
        float stored = read_stored_distance(mirror, ivec3(texel, first_face_layer_of_mirror(mirror) + side));
        if (is_miss(stored) || (has_distance_limit(mirror) && stored >= 1.0)) continue;
        vec2 place = (vec2(texel) + 0.5) / float(face) * 2.0 - 1.0;
        vec3 direction = normalize(cube_direction(int(side), vec3(place, 1)));
        vec3 point = direction * (stored * stored_distance_unit(mirror));
        low = min(low, point);
        high = max(high, point);
        float angle = pow(1.0 + dot(place, place), -1.5);
        sum += angle * vec2(stored * stored_distance_unit(mirror), 1);
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
    if (me == 0u) proxies[mirror] = ProxyShapes(lows[0], highs[0], sums[0].y > 0.0 ? sums[0].x / sums[0].y : 0.0);
}
