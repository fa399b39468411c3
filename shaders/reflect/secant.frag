// Technique `secant`: secant search (Szirmay-Kalos, Aszodi, Lazanyi, Premecz 2005; GPU Gems 3, chapter 17). Finds the
// point of the reflected ray whose distance from the capture's centre equals the captured distance in that direction.
// The first guess uses the captured distance in the ray's own direction (seed report: p = x + R d_p). The next steps
// are false position of inverse distances, for which the first step is exact on a plane. The search needs steps + 2
// fetches where the captured distance is smooth. Of several crossings it finds an arbitrary one.
// More steps follow only if these find no crossing: at silhouettes, and if the ray's own direction shows no surface. In
// the second case no distance gives a first guess, so the search bisects the arc.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#define CONTINUE
#include "lib/constants.glsl"
#include "lib/probe.glsl"
const float kEdge = 1.0 / 2.0;
#include "reflect/crossing.glsl"

layout(constant_id = OWN_CONSTANTS) const uint steps = 2u;

const uint kBisectionSteps = 6u;

// Returns the place at which the ray is as far along as the surface that the capture shows in the ray's own direction.
vec2 guess_crossing_at_captured_distance(RayArc arc, vec3 offset, vec3 direction, float distance) {
    float t = max(distance - dot(offset, direction), 0.0);
    return normalize(vec2(length(offset) + t * arc.end.x, t * arc.end.y));
}

// Bisects the arc towards the edge of the captured surface, because the ray's own direction shows no surface. Stops at
// a place where the ray is behind a surface.
void bisect_towards_surface_edge(uint mirror, RayArc arc, inout ArcSample front, inout ArcSample end) {
    uint i = 0u;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        if (!is_ray_behind_surface(end)) {
            count_search_step();
            ArcSample middle = sample_capture_on_arc(mirror, arc, normalize(front.place + end.place));
            if (middle.captured > 0.0 && !is_ray_behind_surface(middle)) front = middle;
            else end = middle;
        }
        ++i;
    } while (i < kBisectionSteps && !is_ray_behind_surface(end));
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    float first = captured_distance(mirror, direction);
    RayArc arc;
    if (!make_ray_arc(offset, direction, arc)) return Lookup(direction, is_miss(first) ? kMiss : kHit, 0.0, 0.0);
    bool leaves = is_miss(first);
    ArcSample front = ArcSample(vec2(1, 0), 0.0, -1.0 / length(offset)), behind = ArcSample(arc.end,
        reciprocal_or_zero(first), reciprocal_or_zero(first));
    if (leaves) {
        bisect_towards_surface_edge(mirror, arc, front, behind);
        if (!is_ray_behind_surface(behind)) {
            if (front.captured > 0.0 && bisect_to_missing_surface_edge(mirror, arc, front, behind))
                return Lookup(arc_direction_at(arc, front.place), kHit, abs(front.depth) / front.captured, 0.0);
            if (!is_ray_behind_surface(behind)) return Lookup(direction, kMiss, 0.0, 0.0);
        }
    } else {
        vec2 place = guess_crossing_at_captured_distance(arc, offset, direction, first);
        for (uint i = 0u; i < steps; ++i) {
            count_search_step();
            ArcSample next = sample_capture_on_arc(mirror, arc, place);
            if (is_ray_behind_surface(next)) behind = next;
            else front = next;
            place = estimate_crossing_between_samples(front, behind);
            float residual = abs(next.depth) / next.captured;
            if (residual <= kSurfaceTolerance) return Lookup(arc_direction_at(arc, place), kHit, residual, 0.0);
        }
    }
    Lookup found = find_surface_crossing(mirror, arc, front, behind);
    if (leaves && found.state == kUnknown) return Lookup(direction, kUnknown, 1.0, kLeaves);
    return found;
}
#include "lib/mirror.glsl"
