// The reflected ray as an arc of directions from the capture's centre. Several searches share this code.
//
// All distances are inverse distances from the centre. A place is a unit vector in the plane of the ray and the centre,
// and stands for a direction of the arc. The inverse distance of the ray is a linear function of the place, and so is
// the inverse distance of any plane. No surface has the inverse distance 0, so no infinities occur. If the captured
// surface is a plane, one step of false position finds the exact intersection, however far away it is.
#ifndef CATOPTRIC_ARC_GLSL
#define CATOPTRIC_ARC_GLSL

#include "reflect/silhouette.glsl"

// The arc. The ray's start lies in the direction `from`, and its end at infinity in the ray's own direction.
struct RayArc {
    vec3 from, side; // orthogonal unit vectors; the place (x, y) is the direction from * x + side * y
    vec2 end;        // place of the ray's own direction
    float height;    // distance of the ray's line from the centre
};

// The angle, one texel of the largest cube map, below which an arc counts as a single direction.
const float kMinArcAngle = kPi / 2.0 / 16384.0;

// Sets up the arc of a ray that starts at `offset` from the capture's centre. Returns false if the ray's line passes
// through the centre, so that the arc is only the ray's own direction.
bool make_ray_arc(vec3 offset, vec3 direction, out RayArc arc) {
    float size = length(offset);
    arc.from = size > 0.0 ? offset / size : direction;
    arc.end.x = dot(arc.from, direction);
    vec3 across = direction - arc.from * arc.end.x;
    arc.end.y = length(across);
    arc.side = across / arc.end.y;
    arc.height = size * arc.end.y;
    return arc.end.y > kMinArcAngle;
}

vec3 arc_direction_at(RayArc arc, vec2 place) { return arc.from * place.x + arc.side * place.y; }
float sine_between(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
vec2 rotate_arc_place(vec2 place, float sine) { return normalize(place + sine * vec2(-place.y, place.x)); }

// Returns the ray's inverse distance at a place. make_inverse_distance_plane returns the vector whose dot product with a place is this
// inverse distance.
float inverse_ray_distance_at(RayArc arc, vec2 place) { return sine_between(place, arc.end) / arc.height; }
vec2 make_inverse_distance_plane(RayArc arc) { return vec2(arc.end.y, -arc.end.x) / arc.height; }

#endif
