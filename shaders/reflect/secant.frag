// Secant search (Szirmay-Kalos, Aszodi, Lazanyi, Premecz 2005; GPU Gems 3, chapter 17): the point of the
// reflected ray where its distance from the capture's centre equals what was captured in that direction.
// steps + 2 fetches where the distance is smooth. It begins where the ray's own direction, which is behind
// all there is, says that it ends (seed eq. p = x + R d_p), and goes on by false position, of inverse
// distances: on a plane the first step is exact. Picks any of several crossings.
// More is asked only where that finds nothing: at silhouettes, and where the ray's own direction meets
// nothing, so that no distance says where to begin. There halves of the arc are tried.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CONTINUE
#include "lib/constants.glsl"
#include "lib/probe.glsl"
const float kEdge = 1.0 / 2.0;
#include "reflect/crossing.glsl"

layout(constant_id = OWN_CONSTANTS) const uint steps = 2u;

const uint kHalves = 6u;

// The place where the ray is as far away as what its own direction meets.
vec2 first_guess(Arc arc, vec3 offset, vec3 direction, float distance) {
    float t = max(distance - dot(offset, direction), 0.0);
    return normalize(vec2(length(offset) + t * arc.end.x, t * arc.end.y));
}

// Its own direction meets nothing: halves of the arc are tried, towards the edge of what was captured.
void halve(uint mirror, Arc arc, inout Sample front, inout Sample end) {
    uint i = 0u;
    do { // loops ask at their end: see lib/trace.glsl
        if (!is_behind(end)) {
            Sample middle = sample_at(mirror, arc, normalize(front.place + end.place));
            if (middle.captured > 0.0 && !is_behind(middle)) front = middle;
            else end = middle;
        }
        ++i;
    } while (i < kHalves && !is_behind(end));
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float first = captured_distance(mirror, direction);
    Arc arc;
    if (!make_arc(offset, direction, arc)) return Lookup(direction, is_miss(first) ? kMiss : kHit, 0.0, 0.0);
    bool leaves = is_miss(first);
    Sample front = Sample(vec2(1, 0), 0.0, -1.0 / length(offset)), behind = Sample(arc.end, inverse(first), inverse(first));
    if (leaves) {
        halve(mirror, arc, front, behind);
        if (!is_behind(behind)) {
            if (front.captured > 0.0 && meets_at_edge(mirror, arc, front, behind))
                return Lookup(direction_at(arc, front.place), kHit, abs(front.depth) / front.captured, 0.0);
            if (!is_behind(behind)) return Lookup(direction, kMiss, 0.0, 0.0);
        }
    } else {
        vec2 place = first_guess(arc, offset, direction, first);
        for (uint i = 0u; i < steps; ++i) {
            Sample next = sample_at(mirror, arc, place);
            if (is_behind(next)) behind = next;
            else front = next;
            place = false_position(front, behind);
            float residual = abs(next.depth) / next.captured;
            if (residual <= kOnSurface) return Lookup(direction_at(arc, place), kHit, residual, 0.0);
        }
    }
    Lookup found = crossing(mirror, arc, front, behind);
    if (leaves && found.state == kUnknown) return Lookup(direction, kUnknown, 1.0, kLeaves);
    return found;
}
#include "lib/mirror.glsl"
