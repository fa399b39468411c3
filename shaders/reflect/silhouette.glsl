// What tells a surface that a ray crosses from the outline of one that it passes behind.
#ifndef CATOPTRIC_SILHOUETTE_GLSL
#define CATOPTRIC_SILHOUETTE_GLSL

#include "lib/probe.glsl"

// A surface steeper than this against the directions from the centre (tangent of the angle at which it is
// seen) may be two that bilinear lookup joins.
const float kSteepest = 4.0;
// ... unless the step from texel to texel is that small a part of the distance: one of unorm8 is.
const float kSmallStep = 1.0 / 128.0;

float texel_angle(uint mirror) { return 2.0 / float(distance_edge(mirror)); } // in the middle of a face
float inverse(float distance) { return is_miss(distance) ? 0.0 : 1.0 / distance; } // 0: nothing

// One surface goes on; or it ends and one further away begins, either of which the ray may meet, but nothing
// it could pass behind; or one nearer by begins, and the ray is behind that.
const uint kGoesOn = 0u, kEnds = 1u, kSilhouette = 2u;

// Between two unit directions that are close together, where the ray is before and behind what is captured,
// one over which distance is given. At most four more lookups, where the two are steep.
uint what_is_between(uint mirror, vec3 front, vec3 behind, float captured_front, float captured_behind) {
    if (captured_front == 0.0) return kSilhouette;
    float rise = captured_behind - captured_front, angle = length(behind - front);
    if (abs(rise) <= max(kSteepest, kSmallStep / texel_angle(mirror)) * angle * captured_front) return kGoesOn;
    // A plane seen at a grazing angle goes on as steeply on one side at least, beyond the texel that a
    // bilinear lookup mixes in.
    float apart = 1.25 * texel_angle(mirror);
    vec3 move = (behind - front) * (apart / angle);
    // One lookup in a loop, which is unrolled unless it is one that traces (lib/ablate.glsl).
    const vec4 away = vec4(-1, -2, 2, 1);
    vec4 beside;
    for (int i = 0; i < 4; ++i)
        beside[i] = inverse(captured_distance(mirror, normalize((i < 2 ? front : behind) + away[i] * move)));
    float before = beside[0] - beside[1], after = beside[2] - beside[3];
    float slope = rise < 0.0 ? -min(before, after) : max(before, after);
    if (abs(rise) <= 1.5 * slope * angle / apart) return kGoesOn;
    return rise < 0.0 ? kEnds : kSilhouette;
}

#endif
