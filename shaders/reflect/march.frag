// Technique `march`: marches along the reflected ray in equal angles. Seen from the capture's centre, the ray is an
// arc, so equal angles are equal steps in texels. Equal steps along the ray itself would be too dense near its start
// and too wide far away. The last step ends at the ray's own direction, which the ray reaches at infinity.
// The march skips no surface that is wider than arc / steps. After a silhouette the march continues, because the ray
// may come back into sight of the centre. A surface that the ray then meets is the result, with the state unknown.
// Otherwise, the surface last seen beside the silhouette is assumed to continue behind the silhouette.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#define CONTINUE
#include "lib/constants.glsl"
#include "lib/probe.glsl"
const float kEdge = 1.0 / 8.0;
#include "reflect/crossing.glsl"

layout(constant_id = OWN_CONSTANTS) const uint steps = 16u;

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    RayArc arc;
    if (!make_ray_arc(offset, direction, arc))
        return Lookup(direction, is_miss(captured_distance(mirror, direction)) ? kMiss : kHit, 0.0, 0.0);
    float step = atan(arc.end.y, arc.end.x) / float(steps);
    vec2 turn = vec2(cos(step), sin(step)), place = vec2(1, 0);
    ArcSample last = sample_capture_on_arc(mirror, arc, place);
    uint state = is_ray_behind_surface(last) ? kUnknown : kHit;
    Lookup guess = Lookup(direction, kUnknown, 1.0, 0.0);
    uint k = 0u;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        ArcSample next;
        bool goes_behind = false, ends = false;
        do {
            ++k;
            count_search_step();
            place = k == steps ? arc.end : vec2(place.x * turn.x - place.y * turn.y, place.x * turn.y + place.y * turn.x);
            next = sample_capture_on_arc(mirror, arc, place);
            goes_behind = !is_ray_behind_surface(last) && is_ray_behind_surface(next);
            ends = !is_ray_behind_surface(last) && last.captured > 0.0 && next.captured == 0.0;
            if (!goes_behind && !ends) last = next;
        } while (k < steps && !goes_behind && !ends);
        ArcSample front = last, behind = next;
        if (ends && bisect_to_missing_surface_edge(mirror, arc, front, behind))
            return Lookup(arc_direction_at(arc, front.place), state, abs(front.depth) / front.captured, 0.0);
        if ((goes_behind || ends) && is_ray_behind_surface(behind)) {
            Lookup found = find_surface_crossing(mirror, arc, front, behind);
            if (found.state == kHit) return Lookup(found.direction, state, found.residual, 0.0);
            state = kUnknown;
            guess = found;
        }
        last = next;
    } while (k < steps);
    if (is_ray_behind_surface(last)) return guess;
    return Lookup(direction, state == kHit ? kMiss : kUnknown, 0.0, 0.0);
}
#include "lib/mirror.glsl"
