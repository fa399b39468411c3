// How a search ends: between two places of the arc, before and behind a surface, or before one and beside it.
// The including shader says, as kEdge, to which part of a texel it wants to know where a surface ends beside
// nothing.
#ifndef CATOPTRIC_CROSSING_GLSL
#define CATOPTRIC_CROSSING_GLSL

#include "reflect/arc.glsl"
#include "reflect/silhouette.glsl"

// What is captured at a place of the arc.
struct Sample {
    vec2 place;
    float captured; // one over its distance; 0: nothing
    float depth;    // ... minus one over the ray's; see is_behind
};

Sample sample_at(uint mirror, Arc arc, vec2 place) {
    float captured = inverse(captured_distance(mirror, direction_at(arc, place)));
    return Sample(place, captured, captured - ray_at(arc, place));
}

// The ray is behind what is captured there. Nothing is never in front of it, not even where it ends.
bool is_behind(Sample s) { return s.captured > 0.0 && s.depth >= 0.0; }

// Where the depth is 0 if one plane is seen at both, before and behind; between the two whatever is seen.
vec2 false_position(Sample front, Sample behind) {
    return normalize(front.place * behind.depth - behind.place * front.depth);
}

const uint kMaxRefinements = 16u;
// A distance that near to the captured one, as a share of it, is found.
const float kOnSurface = 1.0 / 512.0;

bool are_apart(Sample front, Sample behind, float texel) {
    return sine_between(front.place, behind.place) > (front.captured > 0.0 ? 0.5 : kEdge) * texel;
}

// A hit where a surface is crossed. Unknown at a silhouette: what is seen a texel beside it, or that the ray
// leaves where nothing is.
Lookup crossing(uint mirror, Arc arc, Sample front, Sample behind) {
    float texel = texel_angle(mirror);
    uint i = 0u;
    bool is_wide = are_apart(front, behind, texel);
    do { // loops ask at their end: see lib/trace.glsl
        if (is_wide) {
            bool halves = (i & 1u) == 1u;
            Sample middle = sample_at(mirror, arc, halves ? normalize(front.place + behind.place) : false_position(front, behind));
            if (is_behind(middle)) behind = middle;
            else front = middle;
            float residual = abs(middle.depth) / middle.captured;
            if (!halves && residual <= kOnSurface)
                return Lookup(direction_at(arc, false_position(front, behind)), kHit, residual, 0.0);
        }
        ++i;
        is_wide = i < kMaxRefinements && are_apart(front, behind, texel);
    } while (is_wide);
    if (what_is_between(mirror, direction_at(arc, front.place), direction_at(arc, behind.place), front.captured,
                        behind.captured) == kSilhouette) {
        if (front.captured == 0.0) return Lookup(direction_at(arc, arc.end), kUnknown, 1.0, kLeaves);
        return Lookup(direction_at(arc, rotated(front.place, -texel)), kUnknown, 1.0, 0.0);
    }
    return Lookup(direction_at(arc, false_position(front, behind)), kHit, (behind.depth - front.depth) / behind.captured, 0.0);
}

// From a sample before a surface to one where nothing is. Where the ray goes behind something on the way,
// that is the new `next`. Otherwise the two are left on both sides of the surface's edge; true if the ray
// meets the surface between them, in `front`, which goes on there as it did.
bool meets_at_edge(uint mirror, Arc arc, inout Sample front, inout Sample next) {
    Sample earlier = front;
    float least = kEdge * texel_angle(mirror);
    uint i = 0u;
    bool is_wide = sine_between(front.place, next.place) > least;
    do {
        if (is_wide) {
            Sample middle = sample_at(mirror, arc, normalize(front.place + next.place));
            if (middle.captured == 0.0) next = middle;
            else if (is_behind(middle)) {
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
