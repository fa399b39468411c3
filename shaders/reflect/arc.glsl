// What searches share: the reflected ray as an arc about the capture's centre.
//
// Everything is said in inverse distances. A direction of the arc is a place, a unit vector in the plane of
// the ray and the centre. There one over the ray's distance is a linear function of the place, one over that
// of any plane is another, and nothing at all is 0: no infinity to step around, and on a plane one false
// position is exact, from as far away as may be.
#ifndef CATOPTRIC_ARC_GLSL
#define CATOPTRIC_ARC_GLSL

#include "reflect/silhouette.glsl"

// The ray's points lie along `from` at first and along its own direction at last.
struct Arc {
    vec3 from, side; // unit, at a right angle: place (x, y) is the direction from x + side y
    vec2 end;        // place of the ray's own direction
    float height;    // of the ray above the centre
};

// Below this angle, a texel of the largest cube, the arc is one direction.
const float kOneDirection = kPi / 2.0 / 16384.0;

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

// One over the ray's distance at a place, and the vector whose product with the place it is.
float ray_at(Arc arc, vec2 place) { return sine_between(place, arc.end) / arc.height; }
vec2 ray_plane(Arc arc) { return vec2(arc.end.y, -arc.end.x) / arc.height; }

#endif
