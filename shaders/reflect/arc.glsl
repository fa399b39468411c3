// What searches share: the reflected ray as an arc about the capture's centre, and how a crossing between
// two of its points is told from a silhouette.
//
// Everything is said in inverse distances. A direction of the arc is a place, a unit vector in the plane of
// the ray and the centre. There one over the ray's distance is a linear function of the place, one over that
// of any plane is another, and nothing at all is 0: no infinity to step around, and on a plane one false
// position is exact, from as far away as may be.
#ifndef CATOPTRIC_ARC_GLSL
#define CATOPTRIC_ARC_GLSL

#include "lib/probe.glsl"

// The ray's points lie along `from` at first and along its own direction at last.
struct Arc {
    vec3 from, side; // unit, at a right angle: place (x, y) is the direction from x + side y
    vec2 end;        // place of the ray's own direction
    float height;    // of the ray above the centre
};

// Below this bend, a texel of the largest cube, the arc is one direction.
const float kOneDirection = kPi / 2.0 / 16384.0;
// A surface steeper than this against the directions from the centre (tangent of the angle at which it is
// seen) may be a silhouette: two surfaces that bilinear lookup joins.
const float kSteepest = 4.0;
// ... unless the step is that small a part of the distance: one of unorm8 is.
const float kSmallStep = 1.0 / 128.0;

// False: the ray goes straight away from the centre, or through it; then only its own direction is of use.
bool make_arc(vec3 offset, vec3 direction, out Arc arc) {
    float size = length(offset);
    arc.from = size > 0.0 ? offset / size : direction;
    arc.end.x = dot(arc.from, direction);
    vec3 across = direction - arc.from * arc.end.x;
    arc.end.y = length(across);
    arc.side = across / arc.end.y;
    arc.height = size * arc.end.y;
    return arc.end.y > kOneDirection;
}

vec3 direction_at(Arc arc, vec2 place) { return arc.from * place.x + arc.side * place.y; }
float sine_between(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
vec2 rotated(vec2 place, float sine) { return normalize(place + sine * vec2(-place.y, place.x)); }
float texel_angle() { return 2.0 / float(textureSize(distance_cubes, 0).x); } // in the middle of a face
float inverse(float distance) { return is_miss(distance) ? 0.0 : 1.0 / distance; }

// One over the ray's distance.
float ray_at(Arc arc, vec2 place) { return sine_between(place, arc.end) / arc.height; }

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

// Two samples that are close together, before and behind what is captured, without a surface between them.
bool is_silhouette(uint mirror, Arc arc, Sample front, Sample behind) {
    if (front.captured == 0.0) return true;
    float rise = behind.captured - front.captured;
    // Where the distance grows there is nothing the ray could pass behind.
    if (rise <= 0.0) return false;
    float angle = sine_between(front.place, behind.place);
    if (rise <= max(kSteepest * angle, kSmallStep) * front.captured) return false;
    // Steep: a plane seen at a grazing angle goes on as steeply on one side at least, beyond the texel that a
    // bilinear lookup mixes in.
    float apart = 1.25 * texel_angle();
    Sample before = sample_at(mirror, arc, rotated(front.place, -apart)), after = sample_at(mirror, arc, rotated(behind.place, apart));
    float slope = max(before.captured - sample_at(mirror, arc, rotated(front.place, -2.0 * apart)).captured,
                      sample_at(mirror, arc, rotated(behind.place, 2.0 * apart)).captured - after.captured) / apart;
    return !(rise <= 2.0 * slope * angle);
}

#endif
