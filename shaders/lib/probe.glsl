// Looking into a capture: colour, distance, and what a search for the right direction returns.
#ifndef CATOPTRIC_PROBE_GLSL
#define CATOPTRIC_PROBE_GLSL

#include "lib/bindings.glsl"
#include "lib/constants.glsl"

// Scene units of a stored 1: 1 for float formats, the range for unorm8.
layout(constant_id = STORED_UNIT_CONSTANT) const float stored_unit = 1.0;

// A hit: the search ended on a captured surface. Unknown: the ray went behind something that hides
// the rest of it from the capture's centre. A miss: the ray leaves without meeting anything captured.
const uint kHit = 0u, kUnknown = 1u, kMiss = 2u;

// Where in a capture the radiance that arrives along a ray is to be found.
struct Lookup {
    vec3 direction; // from the capture's centre, unit
    uint state;
    float residual; // relative distance between the found point and the captured surface there
    float layer;    // 0: the nearest surface; 1: the one behind it, where captures have two; see kLeaves
};

// Lookup::layer of an unknown whose best guess is that the ray leaves: it went behind a silhouette beside
// which nothing was captured. Its direction is the ray's own, and it sees nothing.
const float kLeaves = 1.0;

// 1: colours are mixed only from texels of one object.
layout(constant_id = BY_OBJECT_CONSTANT) const uint by_object = 0u;

vec3 bilinear_colour(uint mirror, vec3 direction) { return textureLod(colour_cubes, vec4(direction, mirror), 0).rgb; }

// Of the objects in the four texels around a direction the one with the greatest weight, from its texels only.
vec3 colour_of_object(uint mirror, vec3 direction) {
    vec4 at = vec4(direction, mirror);
    vec4 numbers = textureGather(surface_cubes, at, 0);
    if (all(equal(numbers, numbers.xxxx))) return bilinear_colour(mirror, direction);
    vec3 place = cube_coordinates(cube_face(direction), direction);
    vec2 share = fract((place.xy / place.z * 0.5 + 0.5) * float(textureSize(surface_cubes, 0).x) - 0.5);
    vec4 weights = vec4(1.0 - share.x, share.x, share.x, 1.0 - share.x) * vec4(share.yy, 1.0 - share.yy);
    vec4 best = vec4(0);
    for (int i = 0; i < 4; ++i) {
        vec4 of_object = weights * vec4(equal(numbers, vec4(numbers[i])));
        if (dot(of_object, vec4(1)) > dot(best, vec4(1))) best = of_object;
    }
    best /= dot(best, vec4(1));
    return vec3(dot(best, textureGather(colour_cubes, at, 0)), dot(best, textureGather(colour_cubes, at, 1)),
                dot(best, textureGather(colour_cubes, at, 2)));
}

vec3 captured_colour(uint mirror, vec3 direction) {
    return by_object != 0u ? colour_of_object(mirror, direction) : bilinear_colour(mirror, direction);
}

// What a search that captures one layer found: nothing where it takes the ray to leave.
vec3 found_colour(uint mirror, Lookup lookup) {
    if (lookup.state == kUnknown && lookup.layer == kLeaves) return vec3(0);
    return captured_colour(mirror, lookup.direction);
}

#ifdef MEND // see lib/mend.glsl
bool mends(uint cause);
float exact_distance(uint mirror, vec3 direction);
#endif

// 0: only for measuring what the test costs and what it is worth (docs/robustness.md).
layout(constant_id = TESTS_VOID_CONSTANT) const uint tests_void = 1u;

// Distance from the capture's centre, bilinear. Where one of the four texels holds nothing
// (+infinity), the sum is not finite and the nearest texel decides.
float captured_distance(uint mirror, vec3 direction) {
#ifdef MEND
    if (mends(kMendDistance)) return exact_distance(mirror, direction);
#endif
    float d = textureLod(distance_cubes, vec4(direction, mirror), 0).r;
    if (tests_void != 0u && is_miss(d)) d = textureLod(distance_cubes_nearest, vec4(direction, mirror), 0).r;
    return d * stored_unit;
}

#endif
