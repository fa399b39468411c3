// Secant search (Szirmay-Kalos, Aszodi, Lazanyi, Premecz 2005; GPU Gems 3, chapter 17): the point of the
// reflected ray where its distance from the capture's centre equals what was captured in that direction.
// steps + 3 fetches; order about 1.6 where the distance is smooth. Picks any of several crossings, and
// oscillates at silhouettes, where no bracket exists. Where nothing was captured the ray is in front, but no
// distance says by how much: the secant needs two samples that have one. From one alone the step is
// first * (1 - q), as at the start: along the ray q is linear on a plane, and 1 / first is its slope on the
// plane that the ray's own direction meets. A ray that passes outside its edge is led back into the void.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CONTINUE
#include "lib/probe.glsl"

layout(constant_id = 4) const uint steps = 2u;
// A search that ends further than this from the captured surface has not found it.
const float kTolerance = 0.05;

// |p| over what is captured in its direction: below 1 in front of the surface, above behind it.
float depth_ratio(uint mirror, vec3 p) {
    float size = length(p);
    float d = captured_distance(mirror, p / size);
    return is_miss(d) || !(size > 0.0) ? 0.0 : size / d;
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float first = captured_distance(mirror, direction);
    if (is_miss(first)) return Lookup(direction, kMiss, 0.0, 0.0);
    float t = first - dot(offset, direction);
    float q = depth_ratio(mirror, offset + direction * t);
    bool has_front = q < 1.0, has_behind = !has_front;
    float front = t, behind = t, q_front = q, q_behind = q;
    t = max(t + first * (1.0 - q), 0.0);
    for (uint i = 0u; i < steps; ++i) {
        q = depth_ratio(mirror, offset + direction * t);
        float from, q_from;
        if (q < 1.0) {
            front = t, q_front = q, has_front = true;
            from = behind, q_from = q_behind;
        } else {
            behind = t, q_behind = q, has_behind = true;
            from = front, q_from = q_front;
        }
        bool is_bracket = has_front && has_behind && q_front > 0.0;
        float move = is_bracket ? (t - from) * (1.0 - q) / (q - q_from) : first * (1.0 - q);
        if (!is_finite(move)) break;
        t = max(t + move, 0.0);
    }
    vec3 p = offset + direction * t;
    q = depth_ratio(mirror, p);
    float residual = abs(q - 1.0);
    if (residual <= kTolerance) return Lookup(normalize(p), kHit, residual, 0.0);
    // Not found, and there is nothing here or nothing in front: it went out beside a silhouette.
    bool leaves = q == 0.0 || (has_front && q_front == 0.0 && q > 1.0);
    if (leaves) return Lookup(direction, kUnknown, residual, kLeaves);
    float size = length(p);
    return Lookup(size > 0.0 ? p / size : direction, kUnknown, residual, 0.0);
}
#include "lib/mirror.glsl"
