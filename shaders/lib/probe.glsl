// Lookups in a capture: colour, distance, and the result of a search.
#ifndef CATOPTRIC_PROBE_GLSL
#define CATOPTRIC_PROBE_GLSL

#include "lib/captures.glsl"
#include "lib/environment.glsl"

// Answers of a search. Hit: the search ended on a captured surface. Unknown: the ray went behind a surface that hides
// the rest of the ray from the capture's centre. Miss: the ray leaves the scene without meeting a captured surface.
const uint kHit = 0u, kUnknown = 1u, kMiss = 2u;

// The result of a search: the place in a capture that shows the radiance along a reflected ray.
struct Lookup {
    vec3 direction; // unit direction of the lookup from the capture's centre
    uint state;     // answer of the search: kHit, kUnknown or kMiss
    float residual; // relative distance between the found point and the captured surface in its direction
    float layer;    // capture layer: 0 for the nearest surface, 1 for the surface behind it; or kLeaves
};

// Lookup::layer of an unknown ray that probably leaves the scene, because it went behind a silhouette beside which no
// surface was captured. The lookup's direction is then the ray's own, and its colour is the environment's.
const float kLeaves = 1.0;

// 1: a lookup interpolates colours only between texels of one object.
layout(constant_id = BY_OBJECT_CONSTANT) const uint by_object = 0u;

vec3 captured_colour_bilinear(uint mirror, vec3 direction) {
#define COLOUR(i) textureLod(COLOUR_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 0).rgb
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, COLOUR)
}

// Each of these functions gathers one value of the four texels around a direction: object number, red, green or blue.
vec4 gather_object_numbers(uint mirror, vec3 direction) {
#define NUMBERS(i) textureGather(SURFACE_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 0)
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, NUMBERS)
}
vec4 gather_reds(uint mirror, vec3 direction) {
#define REDS(i) textureGather(COLOUR_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 0)
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, REDS)
}
vec4 gather_greens(uint mirror, vec3 direction) {
#define GREENS(i) textureGather(COLOUR_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 1)
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, GREENS)
}
vec4 gather_blues(uint mirror, vec3 direction) {
#define BLUES(i) textureGather(COLOUR_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 2)
    count_colour_lookups(1u);
    RETURN_OF_ARRAY(mirror, BLUES)
}

// Returns the number of texels along a face's edge of the mirror's capture.
int captured_surface_edge(uint mirror) {
#define SURFACE_EDGE(i) textureSize(SURFACE_CUBES(i), 0).x
    RETURN_OF_ARRAY(mirror, SURFACE_EDGE)
}
int distance_edge(uint mirror) {
#define DISTANCE_EDGE(i) textureSize(DISTANCE_CUBES(i), 0).x
    RETURN_OF_ARRAY(mirror, DISTANCE_EDGE)
}

// Returns the bilinear weights of the four texels around a direction, in the order of textureGather.
vec4 bilinear_texel_weights(vec3 direction, int edge) {
    vec3 place = cube_coordinates(cube_face(direction), direction);
    vec2 share = fract((place.xy / place.z * 0.5 + 0.5) * float(edge) - 0.5);
    return vec4(1.0 - share.x, share.x, share.x, 1.0 - share.x) * vec4(share.yy, 1.0 - share.yy);
}

// Returns the colour of the object with the greatest weight among the four texels around a direction. Only this
// object's texels contribute.
vec3 captured_colour_of_one_object(uint mirror, vec3 direction) {
    vec4 numbers = gather_object_numbers(mirror, direction);
    if (all(equal(numbers, numbers.xxxx))) return captured_colour_bilinear(mirror, direction);
    vec4 weights = bilinear_texel_weights(direction, captured_surface_edge(mirror));
    vec4 best = vec4(0);
    for (int i = 0; i < 4; ++i) {
        vec4 of_object = weights * vec4(equal(numbers, vec4(numbers[i])));
        if (dot(of_object, vec4(1)) > dot(best, vec4(1))) best = of_object;
    }
    best /= dot(best, vec4(1));
    return vec3(dot(best, gather_reds(mirror, direction)), dot(best, gather_greens(mirror, direction)),
                dot(best, gather_blues(mirror, direction)));
}

vec3 captured_colour(uint mirror, vec3 direction) {
    return by_object != 0u ? captured_colour_of_one_object(mirror, direction) : captured_colour_bilinear(mirror, direction);
}

// Returns the colour that a search in a capture of one layer found. A ray that leaves the scene sees the environment.
vec3 colour_found_by_search(uint mirror, Lookup lookup) {
    bool leaves = lookup.state == kUnknown && lookup.layer == kLeaves;
    if (leaves || (environment_kind != kNoEnvironment && lookup.state == kMiss)) return environment_radiance(lookup.direction);
    return captured_colour(mirror, lookup.direction);
}

#ifdef ABLATE // functions that lib/ablate.glsl defines
bool is_cause_ablated(uint cause);
float trace_exact_distance(uint mirror, vec3 direction);
#endif

// 1: lookups test whether a texel holds no surface. 0 measures the cost and the benefit of the test
// (docs/robustness.md).
layout(constant_id = TESTS_VOID_CONSTANT) const uint tests_void = 1u;

// 1: the device cannot filter textures of 32-bit floats, so the shader interpolates distances itself.
layout(constant_id = DISTANCES_BY_GATHER_CONSTANT) const uint distances_by_gather = 0u;
vec4 gather_distances(uint mirror, vec3 direction) {
#define DISTANCES(i) textureGather(DISTANCE_CUBES_NEAREST(i), vec4(direction, cube_index_of_mirror(mirror)), 0)
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, DISTANCES)
}

// Returns the stored distance in a direction, interpolated bilinearly. nearest_stored_distance takes the nearest texel.
float stored_distance(uint mirror, vec3 direction) {
    if (distances_by_gather != 0u)
        return dot(bilinear_texel_weights(direction, distance_edge(mirror)), gather_distances(mirror, direction));
#define STORED(i) textureLod(DISTANCE_CUBES(i), vec4(direction, cube_index_of_mirror(mirror)), 0).r
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, STORED)
}
float nearest_stored_distance(uint mirror, vec3 direction) {
#define NEAREST_STORED(i) textureLod(DISTANCE_CUBES_NEAREST(i), vec4(direction, cube_index_of_mirror(mirror)), 0).r
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, NEAREST_STORED)
}

// Returns the captured distance in a direction, scene units, interpolated bilinearly. If one of the four texels holds
// no surface (+infinity), the sum is not finite, and the nearest texel decides.
float captured_distance(uint mirror, vec3 direction) {
#ifdef ABLATE
    if (is_cause_ablated(kAblateDistance)) return trace_exact_distance(mirror, direction);
#endif
    float d = stored_distance(mirror, direction);
    if (tests_void != 0u && is_miss(d)) d = nearest_stored_distance(mirror, direction);
    precise float in_units = d * stored_distance_unit(mirror); // `precise` forbids the compiler to reorder this product
    return in_units;
}

#endif
