// Equal-angle march: the reflected ray, seen from the capture's centre, is an arc; equal steps along it
// are equal steps in texels, where equal steps along the ray waste themselves near by and skip far away.
// The first crossing is refined by bisection, then by secant and bisection in turn. Nothing wider than arc / steps is skipped.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CONTINUE
#include "lib/probe.glsl"

layout(constant_id = 4) const uint steps = 16u;
const uint kRefinements = 8u;
const uint kBisections = 4u; // of them first: they notice what lies between the samples
// A crossing wider than this after refinement is a silhouette: what lies behind it was never captured.
const float kTolerance = 0.05;

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float size = length(offset);
    float start = size > 0.0 ? acos(clamp(dot(offset / size, direction), -1.0, 1.0)) : 0.0;
    // Below the angle of a texel of the largest cube the ray's arc is a point.
    if (!(start > kPi / 2.0 / 16384.0)) return Lookup(direction, kHit, 0.0, 0.0);
    float t_front = 0.0, f_front = size - captured_distance(mirror, offset / size);
    bool has_front = f_front < 0.0, was_hidden = !has_front;
    for (uint k = 1u; k <= steps; ++k) {
        float s = start * float(k) / (float(steps) + 0.5);
        float t = size * sin(s) / sin(start - s);
        vec3 p = offset + direction * t;
        float d = captured_distance(mirror, normalize(p));
        float f = is_miss(d) ? -kLargest : length(p) - d;
        if (f < 0.0 || !has_front) {
            has_front = has_front || f < 0.0;
            t_front = t, f_front = f;
            continue;
        }
        float t_behind = t, f_behind = f;
        for (uint i = 0u; i < kRefinements; ++i) {
            bool secant = i >= kBisections && (i & 1u) == 0u && f_front > -kLargest;
            float share = secant ? f_front / (f_front - f_behind) : 0.5;
            t = mix(t_front, t_behind, share);
            p = offset + direction * t;
            d = captured_distance(mirror, normalize(p));
            f = is_miss(d) ? -kLargest : length(p) - d;
            if (f < 0.0)
                t_front = t, f_front = f;
            else
                t_behind = t, f_behind = f;
        }
        float gap = (f_behind - f_front) / length(p);
        bool jump = !(gap <= kTolerance);
        if (jump && f_front == -kLargest) return Lookup(direction, kUnknown, 1.0, kLeaves);
        // Of a jump the far side is where the ray goes on: the hidden surface lies behind what is seen there.
        vec3 found = offset + direction * (jump ? t_front : mix(t_front, t_behind, f_front / (f_front - f_behind)));
        return Lookup(normalize(found), jump ? kUnknown : kHit, min(gap, 1.0), 0.0);
    }
    // Never behind anything: it leaves along its own direction, which the last sample has nearly reached.
    return Lookup(direction, was_hidden && !has_front ? kUnknown : is_miss(captured_distance(mirror, direction)) ? kMiss : kHit, 0.0, 0.0);
}
#include "lib/mirror.glsl"
