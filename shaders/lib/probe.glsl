// Looking into a capture: colour, distance, and what a search for the right direction returns.
#ifndef CATOPTRIC_PROBE_GLSL
#define CATOPTRIC_PROBE_GLSL

#include "lib/captures.glsl"
#include "lib/environment.glsl"

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
// which nothing was captured. Its direction is the ray's own, and it sees the environment.
const float kLeaves = 1.0;

// 1: colours are mixed only from texels of one object.
layout(constant_id = BY_OBJECT_CONSTANT) const uint by_object = 0u;

vec3 bilinear_colour(uint mirror, vec3 direction) {
#define COLOUR(i) textureLod(COLOUR_CUBES(i), vec4(direction, cube_of(mirror)), 0).rgb
    RETURN_OF_ARRAY(mirror, COLOUR)
}

// Each of the four texels around a direction: which object it shows, and red, green or blue.
vec4 object_numbers(uint mirror, vec3 direction) {
#define NUMBERS(i) textureGather(SURFACE_CUBES(i), vec4(direction, cube_of(mirror)), 0)
    RETURN_OF_ARRAY(mirror, NUMBERS)
}
vec4 four_reds(uint mirror, vec3 direction) {
#define REDS(i) textureGather(COLOUR_CUBES(i), vec4(direction, cube_of(mirror)), 0)
    RETURN_OF_ARRAY(mirror, REDS)
}
vec4 four_greens(uint mirror, vec3 direction) {
#define GREENS(i) textureGather(COLOUR_CUBES(i), vec4(direction, cube_of(mirror)), 1)
    RETURN_OF_ARRAY(mirror, GREENS)
}
vec4 four_blues(uint mirror, vec3 direction) {
#define BLUES(i) textureGather(COLOUR_CUBES(i), vec4(direction, cube_of(mirror)), 2)
    RETURN_OF_ARRAY(mirror, BLUES)
}

// Texels along an edge of the mirror's capture.
int surface_edge(uint mirror) {
#define SURFACE_EDGE(i) textureSize(SURFACE_CUBES(i), 0).x
    RETURN_OF_ARRAY(mirror, SURFACE_EDGE)
}
int distance_edge(uint mirror) {
#define DISTANCE_EDGE(i) textureSize(DISTANCE_CUBES(i), 0).x
    RETURN_OF_ARRAY(mirror, DISTANCE_EDGE)
}

// How much each of the four texels around a direction counts, in the order of textureGather.
vec4 texel_weights(vec3 direction, int edge) {
    vec3 place = cube_coordinates(cube_face(direction), direction);
    vec2 share = fract((place.xy / place.z * 0.5 + 0.5) * float(edge) - 0.5);
    return vec4(1.0 - share.x, share.x, share.x, 1.0 - share.x) * vec4(share.yy, 1.0 - share.yy);
}

// Of the objects in the four texels around a direction the one with the greatest weight, from its texels only.
vec3 colour_of_object(uint mirror, vec3 direction) {
    vec4 numbers = object_numbers(mirror, direction);
    if (all(equal(numbers, numbers.xxxx))) return bilinear_colour(mirror, direction);
    vec4 weights = texel_weights(direction, surface_edge(mirror));
    vec4 best = vec4(0);
    for (int i = 0; i < 4; ++i) {
        vec4 of_object = weights * vec4(equal(numbers, vec4(numbers[i])));
        if (dot(of_object, vec4(1)) > dot(best, vec4(1))) best = of_object;
    }
    best /= dot(best, vec4(1));
    return vec3(dot(best, four_reds(mirror, direction)), dot(best, four_greens(mirror, direction)),
                dot(best, four_blues(mirror, direction)));
}

vec3 captured_colour(uint mirror, vec3 direction) {
    return by_object != 0u ? colour_of_object(mirror, direction) : bilinear_colour(mirror, direction);
}

// What a search that captures one layer found: the environment where it takes the ray to leave.
vec3 found_colour(uint mirror, Lookup lookup) {
    bool leaves = lookup.state == kUnknown && lookup.layer == kLeaves;
    if (leaves || (environment_kind != kNoEnvironment && lookup.state == kMiss)) return environment(lookup.direction);
    return captured_colour(mirror, lookup.direction);
}

#ifdef ABLATE // see lib/ablate.glsl
bool ablates(uint cause);
float exact_distance(uint mirror, vec3 direction);
#endif

// 0: only for measuring what the test costs and what it is worth (docs/robustness.md).
layout(constant_id = TESTS_VOID_CONSTANT) const uint tests_void = 1u;

// 1: the device cannot filter 32-bit floats, so this program does.
layout(constant_id = DISTANCES_BY_GATHER_CONSTANT) const uint distances_by_gather = 0u;
vec4 four_distances(uint mirror, vec3 direction) {
#define DISTANCES(i) textureGather(DISTANCE_CUBES_NEAREST(i), vec4(direction, cube_of(mirror)), 0)
    RETURN_OF_ARRAY(mirror, DISTANCES)
}

// As stored, bilinear, and of the nearest texel.
float stored_distance(uint mirror, vec3 direction) {
    if (distances_by_gather != 0u)
        return dot(texel_weights(direction, distance_edge(mirror)), four_distances(mirror, direction));
#define STORED(i) textureLod(DISTANCE_CUBES(i), vec4(direction, cube_of(mirror)), 0).r
    RETURN_OF_ARRAY(mirror, STORED)
}
float nearest_stored_distance(uint mirror, vec3 direction) {
#define NEAREST_STORED(i) textureLod(DISTANCE_CUBES_NEAREST(i), vec4(direction, cube_of(mirror)), 0).r
    RETURN_OF_ARRAY(mirror, NEAREST_STORED)
}

// Distance from the capture's centre, bilinear. Where one of the four texels holds nothing
// (+infinity), the sum is not finite and the nearest texel decides.
float captured_distance(uint mirror, vec3 direction) {
#ifdef ABLATE
    if (ablates(kAblateDistance)) return exact_distance(mirror, direction);
#endif
    float d = stored_distance(mirror, direction);
    if (tests_void != 0u && is_miss(d)) d = nearest_stored_distance(mirror, direction);
    precise float in_units = d * stored_unit_of(mirror); // or what follows could be reordered around it
    return in_units;
}

#endif
