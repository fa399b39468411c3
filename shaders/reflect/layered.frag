// March through captures of two layers. Along the reflected ray's arc (march.frag) the number of captured
// surfaces in front of the sample is watched. Where it changes, bisection to a texel tells a surface that
// goes on from one side to the other, which is met there, from a silhouette, behind which the ray passes on.
// Distances and colours are mixed only from texels of the surface in question, whichever layer holds it.
#version 460
#extension GL_GOOGLE_include_directive : require
#define CONTINUE
#define OWN_LOOKUP_COLOUR
#include "lib/probe.glsl"

layout(constant_id = 4) const uint steps = 16u;
layout(set = 0, binding = 20) uniform sampler2DArray distance1;
layout(set = 0, binding = 21) uniform sampler2DArray distance2;
layout(set = 0, binding = 22) uniform sampler2DArray colour1;
layout(set = 0, binding = 23) uniform sampler2DArray colour2;

const uint kLimit = 512u;       // samples in all
const float kSameSurface = 0.125; // largest relative step from texel to texel within one surface

// The plane of the ray and the capture's centre: a unit vector in it is (x, y) = x from + y side.
// The ray's points lie along (1, 0) at first and along `end` at last.
struct Arc {
    vec3 from, side;
    vec2 end;
    float height; // of the ray above the centre
};
// A direction of the arc: distance from the centre of the ray, and of both layers.
struct Sample {
    vec2 place;
    float ray, first, second;
};

vec3 direction_at(Arc arc, vec2 place) { return arc.from * place.x + arc.side * place.y; }
float sine_between(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
// Law of sines in the triangle of centre, start of the ray and its point in that direction.
float ray_at(Arc arc, vec2 place) {
    float sine = sine_between(place, arc.end);
    return sine > 0.0 ? arc.height / sine : kLargest;
}

int edge() { return textureSize(distance1, 0).x; }
// Position in texels on the face of a direction, and the layer of that face.
vec3 texel_of(uint mirror, vec3 direction) {
    int face = cube_face(direction);
    vec3 c = cube_coordinates(face, direction);
    return vec3((c.xy / c.z * 0.5 + 0.5) * float(edge()), float(6u * mirror) + float(face));
}

Sample sample_at(uint mirror, Arc arc, vec2 place) {
    ivec3 texel = ivec3(texel_of(mirror, direction_at(arc, place)));
    texel.xy = min(texel.xy, ivec2(edge() - 1));
    return Sample(place, ray_at(arc, place), texelFetch(distance1, texel, 0).r * stored_unit,
                  texelFetch(distance2, texel, 0).r * stored_unit);
}

uint surfaces_in_front(Sample s) { return uint(s.ray >= s.first) + uint(s.ray >= s.second); }
bool is_near(float a, float b) { return abs(a - b) <= kSameSurface * b; }

// Nothing happens between the two: as many surfaces in front, and the nearest is the same one.
bool are_alike(Sample a, Sample b) {
    uint count = surfaces_in_front(a);
    return count == surfaces_in_front(b) && (count == 0u || is_near(b.first, a.first));
}

// A surface that lies behind the ray at a and in front of it at b, if there is one: its distance at b.
bool is_crossed(Sample a, Sample b, out float distance) {
    for (uint i = 0u; i < 2u; ++i) {
        float before = i == 0u ? a.first : a.second;
        // It goes on in the layer whose distance is nearer to it.
        distance = abs(b.second - before) < abs(b.first - before) ? b.second : b.first;
        if (a.ray < before && !is_miss(before) && is_near(distance, before) && b.ray >= distance) return true;
    }
    return false;
}

// The four texels around a direction, counted as textureGather does.
struct Taps {
    vec3 at; // where the four meet
    vec4 weights, first;
};
Taps taps_at(uint mirror, vec3 direction) {
    vec3 texel = texel_of(mirror, direction);
    vec2 corner = floor(texel.xy - 0.5), share = texel.xy - 0.5 - corner;
    Taps taps;
    taps.at = vec3((corner + 1.0) / float(edge()), texel.z);
    taps.weights = vec4(1.0 - share.x, share.x, share.x, 1.0 - share.x) * vec4(share.yy, 1.0 - share.yy);
    taps.first = textureGather(distance1, taps.at) * stored_unit;
    return taps;
}

// Which of four distances are those of the surface at about `distance`.
vec4 on_surface(vec4 distances, float distance) {
    return vec4(lessThanEqual(abs(distances - distance), vec4(kSameSurface * distance)));
}
bool is_whole(vec4 chosen) { return dot(chosen, vec4(1)) == 4.0; }

// In each texel the layer that holds the surface, if one does: weights of the first, of the second.
void choose(Taps taps, float distance, out vec4 second, out vec4 in_first, out vec4 in_second) {
    second = textureGather(distance2, taps.at) * stored_unit;
    vec4 is_second = vec4(lessThan(abs(second - distance), abs(taps.first - distance)));
    in_first = taps.weights * (1.0 - is_second) * on_surface(taps.first, distance);
    in_second = taps.weights * is_second * on_surface(second, distance);
}

float sum_where(vec4 weights, vec4 values) { return dot(weights, mix(vec4(0), values, greaterThan(weights, vec4(0)))); }

// Distance of the surface, bilinear over the texels that hold it; none: as it was.
float surface_distance(uint mirror, vec3 direction, float distance) {
    Taps taps = taps_at(mirror, direction);
    if (is_whole(on_surface(taps.first, distance))) return dot(taps.weights, taps.first);
    vec4 second, in_first, in_second;
    choose(taps, distance, second, in_first, in_second);
    float weight = dot(in_first + in_second, vec4(1));
    return weight > 0.0 ? (sum_where(in_first, taps.first) + sum_where(in_second, second)) / weight : distance;
}

float found_distance; // of the lookup; 0: nothing was found. Without initial value, on which -gVS of glslang 12 trips

float looked_at() { return found_distance; }
void look_at(float distance) { found_distance = distance; }

vec3 lookup_colour(uint mirror, Lookup lookup) {
    if (!(found_distance > 0.0)) return vec3(0);
    Taps taps = taps_at(mirror, lookup.direction);
    if (is_whole(on_surface(taps.first, found_distance))) return captured_colour(mirror, lookup.direction);
    vec4 second, in_first, in_second;
    choose(taps, found_distance, second, in_first, in_second);
    float weight = dot(in_first + in_second, vec4(1));
    if (!(weight > 0.0)) return captured_colour(mirror, lookup.direction);
    vec3 colour;
    colour.r = dot(in_first, textureGather(colour1, taps.at, 0)) + dot(in_second, textureGather(colour2, taps.at, 0));
    colour.g = dot(in_first, textureGather(colour1, taps.at, 1)) + dot(in_second, textureGather(colour2, taps.at, 1));
    colour.b = dot(in_first, textureGather(colour1, taps.at, 2)) + dot(in_second, textureGather(colour2, taps.at, 2));
    return colour / weight;
}

// Where the ray meets the surface between two directions a texel apart, by secant.
Lookup meet(uint mirror, Arc arc, vec2 front, vec2 behind, float distance, bool in_second) {
    float d_behind = surface_distance(mirror, direction_at(arc, behind), distance);
    float d_front = surface_distance(mirror, direction_at(arc, front), d_behind);
    float f_front = ray_at(arc, front) - d_front, f_behind = ray_at(arc, behind) - d_behind;
    float share = f_front / (f_front - f_behind);
    share = is_finite(share) ? clamp(share, 0.0, 1.0) : 1.0;
    vec2 place = normalize(mix(front, behind, share));
    found_distance = mix(d_front, d_behind, share);
    float residual = abs(ray_at(arc, place) - found_distance) / found_distance;
    return Lookup(direction_at(arc, place), kHit, min(residual, 1.0), in_second ? 1.0 : 0.0);
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    found_distance = 0.0;
    float size = length(offset);
    Arc arc;
    arc.from = size > 0.0 ? offset / size : direction;
    arc.end.x = dot(arc.from, direction);
    vec3 across = direction - arc.from * arc.end.x;
    arc.end.y = length(across);
    float whole = atan(arc.end.y, arc.end.x);
    // Below the angle of a texel of the largest cube the arc is a point.
    if (!(whole > kPi / 2.0 / 16384.0)) {
        float distance = captured_distance(mirror, direction);
        if (is_miss(distance)) return Lookup(direction, kMiss, 0.0, 0.0);
        found_distance = distance;
        return Lookup(direction, kHit, 0.0, 0.0);
    }
    arc.side = across / arc.end.y;
    arc.height = size * arc.end.y;
    vec2 turn = vec2(cos(whole / float(steps)), sin(whole / float(steps)));
    float texel = 1.0 / float(edge()); // half of one, in the middle of a face
    uint step = 1u;
    vec2 next = turn;
    Sample a = sample_at(mirror, arc, vec2(1, 0)), b = sample_at(mirror, arc, next);
    for (uint i = 0u; i < kLimit; ++i) {
        if (are_alike(a, b)) {
            a = b;
            if (a.place == next) {
                if (step == steps) break;
                ++step;
                next = step == steps ? arc.end : vec2(next.x * turn.x - next.y * turn.y, next.x * turn.y + next.y * turn.x);
            }
            b = sample_at(mirror, arc, next);
        } else if (sine_between(a.place, b.place) > texel) {
            Sample middle = sample_at(mirror, arc, normalize(a.place + b.place));
            if (are_alike(a, middle)) a = middle;
            else b = middle;
        } else {
            float distance;
            if (is_crossed(a, b, distance)) {
                // Texels are steps of the surface: the crossing may lie a texel before their change.
                vec2 front = normalize(a.place - 2.0 * texel * vec2(-a.place.y, a.place.x));
                return meet(mirror, arc, front.y > 0.0 ? front : vec2(1, 0), b.place, distance, distance != b.first);
            }
            a = b;
            b = sample_at(mirror, arc, next);
        }
    }
    // Never met: it leaves, in front of or behind all there is along its own direction, or it was lost
    // behind two surfaces that face the centre.
    bool is_hidden = surfaces_in_front(b) > 0u;
    if (is_miss(is_hidden ? b.second : b.first)) return Lookup(direction, kMiss, 0.0, is_hidden ? 1.0 : 0.0);
    found_distance = b.first;
    return Lookup(direction, kUnknown, 1.0, 0.0);
}
#include "lib/mirror.glsl"
