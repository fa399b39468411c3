// The last steps of a search, which find the crossing of ray and surface between two places of the arc. At the first
// place the ray is in front of a captured surface. At the second place the ray is behind the surface, or no surface was
// captured. The including shader defines kEdge. A surface's edge, beside which no surface was captured, is located to
// kEdge texels.
#ifndef CATOPTRIC_CROSSING_GLSL
#define CATOPTRIC_CROSSING_GLSL

#include "reflect/arc.glsl"
#include "reflect/silhouette.glsl"

// The captured surface at a place of the arc.
struct ArcSample {
    vec2 place;
    float captured; // inverse captured distance; 0: no surface was captured
    float depth;    // inverse captured distance minus inverse distance of the ray (see is_ray_behind_surface)
};

ArcSample sample_capture_on_arc(uint mirror, RayArc arc, vec2 place) {
    float captured = reciprocal_or_zero(captured_distance(mirror, arc_direction_at(arc, place)));
    return ArcSample(place, captured, captured - inverse_ray_distance_at(arc, place));
}

// Returns whether the ray is behind the captured surface at a sample. Without a captured surface, the ray is not
// behind.
bool is_ray_behind_surface(ArcSample s) { return s.captured > 0.0 && s.depth >= 0.0; }

// Returns the place between two samples, in front of and behind a surface, at which the depth is 0 if both show the
// same plane.
vec2 estimate_crossing_between_samples(ArcSample front, ArcSample behind) {
    return normalize(front.place * behind.depth - behind.place * front.depth);
}

const uint kMaxRefinements = 16u;
// The largest difference, relative to the captured distance, at which a ray's point counts as on the captured surface.
const float kSurfaceTolerance = 1.0 / 512.0;

bool are_more_than_texel_apart(ArcSample front, ArcSample behind, float texel) {
    return sine_between(front.place, behind.place) > (front.captured > 0.0 ? 0.5 : kEdge) * texel;
}

// Finds the crossing between two samples. Returns a hit if the ray crosses a surface. Returns unknown at a silhouette,
// with the direction one texel beside the silhouette, or with kLeaves if no surface was captured beside the silhouette.
Lookup find_surface_crossing(uint mirror, RayArc arc, ArcSample front, ArcSample behind) {
    float texel = texel_angle_of_mirror_capture(mirror);
    uint i = 0u;
    bool is_wide = are_more_than_texel_apart(front, behind, texel);
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        if (is_wide) {
            count_search_step();
            bool halves = (i & 1u) == 1u;
            ArcSample middle = sample_capture_on_arc(mirror, arc, halves ? normalize(front.place + behind.place) : estimate_crossing_between_samples(front, behind));
            if (is_ray_behind_surface(middle)) behind = middle;
            else front = middle;
            float residual = abs(middle.depth) / middle.captured;
            if (!halves && residual <= kSurfaceTolerance)
                return Lookup(arc_direction_at(arc, estimate_crossing_between_samples(front, behind)), kHit, residual, 0.0);
        }
        ++i;
        is_wide = i < kMaxRefinements && are_more_than_texel_apart(front, behind, texel);
    } while (is_wide);
    if (classify_surface_between(mirror, arc_direction_at(arc, front.place), arc_direction_at(arc, behind.place), front.captured,
                        behind.captured) == kSurfaceSilhouette) {
        if (front.captured == 0.0) {
            // If something was captured there, `front` is the start of a ray that starts behind a surface. Without an
            // environment it sees what the centre sees in its direction, instead of nothing.
            bool leaves = environment_kind != kNoEnvironment || sample_capture_on_arc(mirror, arc, front.place).captured == 0.0;
            return Lookup(arc_direction_at(arc, arc.end), kUnknown, 1.0, leaves ? kLeaves : 0.0);
        }
        return Lookup(arc_direction_at(arc, rotate_arc_place(front.place, -texel)), kUnknown, 1.0, 0.0);
    }
    return Lookup(arc_direction_at(arc, estimate_crossing_between_samples(front, behind)), kHit, (behind.depth - front.depth) / behind.captured, 0.0);
}

// Bisects between `front`, a sample in front of a surface, and `next`, a sample without a captured surface. If the ray
// goes behind a surface between the two, returns false with `next` behind that surface. Otherwise, leaves the samples
// on the two sides of the surface's edge. Then returns whether the surface, extended linearly, meets the ray between
// the two samples. `front` is the place of that intersection.
bool bisect_to_missing_surface_edge(uint mirror, RayArc arc, inout ArcSample front, inout ArcSample next) {
    ArcSample earlier = front;
    float least = kEdge * texel_angle_of_mirror_capture(mirror);
    uint i = 0u;
    bool is_wide = sine_between(front.place, next.place) > least;
    do {
        if (is_wide) {
            count_search_step();
            ArcSample middle = sample_capture_on_arc(mirror, arc, normalize(front.place + next.place));
            if (middle.captured == 0.0) next = middle;
            else if (is_ray_behind_surface(middle)) {
                next = middle;
                return false;
            } else earlier = front, front = middle;
        }
        ++i;
        is_wide = i < kMaxRefinements && sine_between(front.place, next.place) > least;
    } while (is_wide);
    float beyond = sine_between(next.place, front.place) * earlier.depth + sine_between(earlier.place, next.place) * front.depth;
    return sine_between(earlier.place, front.place) > 0.0 && beyond >= 0.0;
}

#endif
