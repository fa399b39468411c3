// Technique `layered`: marches through captures of two layers. The march follows the reflected ray's arc (arc.glsl).
// At each sample a captured surface is nearer to the capture's centre than the ray, or farther from the centre. The
// march counts the nearer surfaces. If their number changes between two samples, or the nearest of the farther surfaces
// ends, bisection to a part of a texel finds the border. The planes of the texels on the two sides of the border then
// tell which surface the ray meets. If the ray meets neither surface, the border is a silhouette, and the ray passes on
// behind the silhouette.
// Planes and colours come only from texels of the surface that the ray meets, whichever layer holds the texel. If both
// captured surfaces are nearer to the centre than the ray, the last farther surface is assumed to continue.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#define COUNTS_LANES
#define CONTINUE
#define OWN_LOOKUP_COLOUR
#include "lib/constants.glsl"
#include "lib/probe.glsl"
#include "reflect/arc.glsl"

layout(constant_id = OWN_CONSTANTS) const uint steps = 16u;
layout(set = 0, binding = 20) uniform FACES(distance1);
layout(set = 0, binding = 21) uniform FACES(distance2);
layout(set = 0, binding = 22) uniform FACES(colour1);
layout(set = 0, binding = 23) uniform FACES(colour2);

const uint kMaxSearchSamples = 512u; // most samples of one search
const float kMaxSurfaceStep = 0.125; // largest relative step of the distance between neighbouring texels of one surface

// A place of the arc, with the inverse distances of the ray and of both layers; 0: the layer has no surface.
struct ArcSample {
    vec2 place;
    float ray, first, second;
};

// Returns the captured distance, scene units, of a texel in the first layer. second_layer_distance reads the second
// layer.
float first_layer_distance(uint mirror, ivec3 texel) {
#define FIRST(i) texelFetch(FACES_OF(distance1, i), texel, 0).r * stored_distance_unit(mirror)
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, FIRST)
}
float second_layer_distance(uint mirror, ivec3 texel) {
#define SECOND(i) texelFetch(FACES_OF(distance2, i), texel, 0).r * stored_distance_unit(mirror)
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, SECOND)
}
// Returns the captured distances, scene units, of four texels in the first layer. gather_second_layer_distances reads the second
// layer.
vec4 gather_first_layer_distances(uint mirror, vec3 at) {
#define FIRSTS(i) textureGather(FACES_OF(distance1, i), at) * stored_distance_unit(mirror)
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, FIRSTS)
}
vec4 gather_second_layer_distances(uint mirror, vec3 at) {
#define SECONDS(i) textureGather(FACES_OF(distance2, i), at) * stored_distance_unit(mirror)
    count_distance_lookup();
    RETURN_OF_ARRAY(mirror, SECONDS)
}
// Returns the weighted sum of the colours of four texels in both layers.
vec3 sum_weighted_colours(uint mirror, vec3 at, vec4 in_first, vec4 in_second) {
#define WEIGHTED(i)                                                                                                    \
    vec3(dot(in_first, textureGather(FACES_OF(colour1, i), at, 0)) +                                                   \
             dot(in_second, textureGather(FACES_OF(colour2, i), at, 0)),                                               \
         dot(in_first, textureGather(FACES_OF(colour1, i), at, 1)) +                                                   \
             dot(in_second, textureGather(FACES_OF(colour2, i), at, 1)),                                               \
         dot(in_first, textureGather(FACES_OF(colour1, i), at, 2)) +                                                   \
             dot(in_second, textureGather(FACES_OF(colour2, i), at, 2)))
    count_colour_lookups(6u);
    RETURN_OF_ARRAY(mirror, WEIGHTED)
}
// Returns a direction's position on its cube face, in texels, and the array layer of that face.
vec3 direction_to_texel_position(uint mirror, vec3 direction) {
    int face = cube_face(direction);
    vec3 c = cube_coordinates(face, direction);
    return vec3((c.xy / c.z * 0.5 + 0.5) * float(distance_edge(mirror)), float(first_face_layer_of_mirror(mirror)) + float(face));
}

ArcSample sample_layers_on_arc(uint mirror, RayArc arc, vec2 place) {
    ivec3 texel = ivec3(direction_to_texel_position(mirror, arc_direction_at(arc, place)));
    texel.xy = min(texel.xy, ivec2(distance_edge(mirror) - 1));
    return ArcSample(place, inverse_ray_distance_at(arc, place), reciprocal_or_zero(first_layer_distance(mirror, texel)),
                  reciprocal_or_zero(second_layer_distance(mirror, texel)));
}

uint count_surfaces_in_front(ArcSample s) {
    return uint(s.first > 0.0 && s.first >= s.ray) + uint(s.second > 0.0 && s.second >= s.ray);
}
// Returns the inverse distance of the nearest captured surface that is farther from the capture's centre than the ray.
// The surface is that of the first layer, or of the second layer if the ray is behind the first. 0: no such surface.
float inverse_distance_of_next_surface(ArcSample s) {
    uint count = count_surfaces_in_front(s);
    return count == 0u ? s.first : count == 1u ? s.second : 0.0;
}
bool are_similar_distances(float a, float b) { return abs(a - b) <= kMaxSurfaceStep * b; }

// Returns whether a surface ends between two samples of the march. At both samples the same number of captured surfaces
// is nearer to the capture's centre than the ray, but only one sample has a surface that is farther than the ray.
bool does_surface_end_between(ArcSample a, ArcSample b) {
    return count_surfaces_in_front(a) == count_surfaces_in_front(b) &&
        (inverse_distance_of_next_surface(a) > 0.0) != (inverse_distance_of_next_surface(b) > 0.0);
}

// Returns whether two samples of the march see the same surfaces: as many surfaces are nearer to the capture's centre
// than the ray, and the nearest surface is the same.
bool do_samples_see_same_surfaces(ArcSample a, ArcSample b) {
    uint count = count_surfaces_in_front(a);
    return count == count_surfaces_in_front(b) && (count == 0u || are_similar_distances(b.first, a.first)) &&
        !does_surface_end_between(a, b);
}

// Returns the texel's inverse distance from the layer whose inverse distance is closer to `about`.
float inverse_distance_of_closer_layer(uint mirror, float about, ivec3 texel) {
    vec2 both = vec2(reciprocal_or_zero(first_layer_distance(mirror, texel)),
        reciprocal_or_zero(second_layer_distance(mirror, texel)));
    return abs(both.y - about) < abs(both.x - about) ? both.y : both.x;
}

// Returns the smaller change of `mean` from a texel to its two neighbours along an axis. Returns 0 if the two changes
// have opposite signs, since the surface then has an edge.
float smaller_inverse_distance_change(uint mirror, float about, float mean, ivec3 texel, ivec3 step, vec3 coordinates, vec3 move) {
    ivec3 low = texel - step, high = texel + step;
    bool has_low = all(greaterThanEqual(low.xy, ivec2(0))), has_high = all(lessThan(high.xy, ivec2(distance_edge(mirror))));
    float to_low = has_low ? mean - inverse_distance_of_closer_layer(mirror, about,
        low) * length(coordinates - move) : kLargestFloat;
    float to_high = has_high ? inverse_distance_of_closer_layer(mirror, about,
        high) * length(coordinates + move) - mean : kLargestFloat;
    if (has_low && has_high && to_low * to_high <= 0.0) return 0.0;
    float least = abs(to_low) < abs(to_high) ? to_low : to_high;
    return least < kLargestFloat ? least : 0.0;
}

// Returns the plane of the surface with the inverse distance `about` in the texel at a place. The dot product of the
// result with a nearby place is the plane's inverse distance in that place.
vec2 find_surface_plane_at(uint mirror, RayArc arc, vec2 place, float about) {
    int face = cube_face(arc_direction_at(arc, place));
    ivec3 texel = ivec3(direction_to_texel_position(mirror, arc_direction_at(arc, place)));
    texel.xy = min(texel.xy, ivec2(distance_edge(mirror) - 1));
    float size = 2.0 / float(distance_edge(mirror));
    vec3 centre = vec3((vec2(texel.xy) + 0.5) * size - 1.0, 1.0);
    // For a plane, the inverse distance times the length of the face coordinates is linear in these coordinates.
    float mean = about * length(centre);
    vec2 slope = vec2(smaller_inverse_distance_change(mirror, about, mean, texel, ivec3(1, 0, 0), centre, vec3(size, 0, 0)),
                      smaller_inverse_distance_change(mirror, about, mean, texel, ivec3(0, 1, 0), centre, vec3(0, size, 0))) / size;
    vec3 plane = vec3(slope, mean - dot(slope, centre.xy));
    return vec2(dot(plane, cube_coordinates(face, arc.from)), dot(plane, cube_coordinates(face, arc.side)));
}

// The four texels around a direction, in the order of textureGather.
struct GatheredTexels {
    vec3 at; // texture coordinates of the common corner of the four texels
    vec4 weights, first; // bilinear weights, and distances in the first layer
};
GatheredTexels gather_texels_around(uint mirror, vec3 direction) {
    vec3 texel = direction_to_texel_position(mirror, direction);
    vec2 corner = floor(texel.xy - 0.5), share = texel.xy - 0.5 - corner;
    GatheredTexels taps;
    taps.at = vec3((corner + 1.0) / float(distance_edge(mirror)), texel.z);
    taps.weights = vec4(1.0 - share.x, share.x, share.x, 1.0 - share.x) * vec4(share.yy, 1.0 - share.yy);
    taps.first = gather_first_layer_distances(mirror, taps.at);
    return taps;
}

// Returns 1 for each of four distances that belongs to the surface at about `distance`, else 0.
vec4 mark_texels_at_distance(vec4 distances, float distance) {
    return vec4(lessThanEqual(abs(distances - distance), vec4(kMaxSurfaceStep * distance)));
}
bool are_all_texels_chosen(vec4 chosen) { return dot(chosen, vec4(1)) == 4.0; }

// Chooses, for each of the four texels, the layer that shows the surface at about `distance`. Returns the texels'
// weights in the first and second layer. A texel whose layers do not show the surface has weight 0 in both.
void choose_layer_of_texels(uint mirror, GatheredTexels taps, float distance, out vec4 second, out vec4 in_first, out vec4 in_second) {
    second = gather_second_layer_distances(mirror, taps.at);
    vec4 is_second = vec4(lessThan(abs(second - distance), abs(taps.first - distance)));
    in_first = taps.weights * (1.0 - is_second) * mark_texels_at_distance(taps.first, distance);
    in_second = taps.weights * is_second * mark_texels_at_distance(second, distance);
}

// The distance of the looked-up surface from the capture's centre; 0: no surface was found. The variable has no initial
// value, because glslang 12 fails with -gVS on initial values.
float found_distance;

float distance_of_last_search_hit() { return found_distance; }
void set_distance_of_last_search_hit(float distance) { found_distance = distance; }

vec3 lookup_colour(uint mirror, Lookup lookup) {
    if (!(found_distance > 0.0)) return environment_radiance(lookup.direction);
    GatheredTexels taps = gather_texels_around(mirror, lookup.direction);
    if (are_all_texels_chosen(mark_texels_at_distance(taps.first, found_distance))) return captured_colour(mirror,
        lookup.direction);
    vec4 second, in_first, in_second;
    choose_layer_of_texels(mirror, taps, found_distance, second, in_first, in_second);
    float weight = dot(in_first + in_second, vec4(1));
    if (!(weight > 0.0)) return captured_colour(mirror, lookup.direction);
    return sum_weighted_colours(mirror, taps.at, in_first, in_second) / weight;
}

// Returns the intersection of the ray with a plane near `place`.
Lookup intersect_surface_plane(uint mirror, RayArc arc, vec2 plane, vec2 place, float layer) {
    vec2 depth = plane - make_inverse_distance_plane(arc), met = normalize(vec2(-depth.y, depth.x));
    if (dot(met, place) < 0.0) met = -met;
    // The intersection may be at most four half texels from `place`, as far as a texel's plane is valid.
    float reach = 4.0 / float(distance_edge(mirror)), apart = sine_between(place, met);
    if (!(abs(apart) <= reach)) met = place;
    found_distance = 1.0 / dot(plane, met);
    return Lookup(arc_direction_at(arc, met), kHit, min(abs(dot(depth, met)) * found_distance, 1.0), layer);
}

// Returns whether the ray meets a surface of either of two samples that are a part of a texel apart. `is_lost` tells
// whether the surface ahead of the ray at `a` ends before `b`.
bool meets_sampled_surface(uint mirror, RayArc arc, ArcSample a, ArcSample b, out Lookup found, out bool is_lost) {
    vec2 ray = make_inverse_distance_plane(arc);
    uint count = count_surfaces_in_front(a);
    is_lost = inverse_distance_of_next_surface(a) > 0.0;
    vec2 first = b.first > 0.0 ? find_surface_plane_at(mirror, arc, b.place, b.first) : vec2(0);
    vec2 second = b.second > 0.0 ? find_surface_plane_at(mirror, arc, b.place, b.second) : vec2(0);
    uint next = count;
    do {
        uint i = next++;
        float before = i == 0u ? a.first : a.second;
        if (i > 1u || before == 0.0) break;
        vec2 plane = find_surface_plane_at(mirror, arc, a.place, before);
        float at_b = dot(plane, b.place);
        bool in_first = are_similar_distances(dot(first, b.place), at_b),
            in_second = are_similar_distances(dot(second, b.place), at_b);
        if (i == count) is_lost = !in_first && !in_second;
        // The ray meets a surface that continues to `b` and is in front of the ray there. The ray also meets a surface
        // that ends on the way, behind the ray's intersection.
        bool is_behind = at_b >= b.ray || (in_first && b.first >= b.ray) || (!in_first && in_second && b.second >= b.ray);
        if (!is_behind) continue;
        found = intersect_surface_plane(mirror, arc, plane, a.place, in_first || i == 0u ? 0.0 : 1.0);
        return true;
    } while (next < 2u);
    // The ray meets a surface that begins at `b` if this surface is ahead of the ray there.
    if (count == 0u && b.first >= b.ray && b.first > 0.0 && dot(first, b.place) < b.ray) {
        found = intersect_surface_plane(mirror, arc, first, b.place, 0.0);
        return true;
    }
    return false;
}

Lookup search(uint mirror, vec3 offset, vec3 direction) {
    found_distance = 0.0;
    RayArc arc;
    if (!make_ray_arc(offset, direction, arc)) {
        float distance = captured_distance(mirror, direction);
        if (is_miss(distance)) return Lookup(direction, kMiss, 0.0, 0.0);
        found_distance = distance;
        return Lookup(direction, kHit, 0.0, 0.0);
    }
    float whole = atan(arc.end.y, arc.end.x);
    vec2 turn = vec2(cos(whole / float(steps)), sin(whole / float(steps)));
    float half_texel = 1.0 / float(distance_edge(mirror)); // angle of half a texel in the middle of a face
    uint step = 1u;
    vec2 next = steps == 1u ? arc.end : turn;
    ArcSample a = sample_layers_on_arc(mirror, arc, vec2(1, 0)), b = sample_layers_on_arc(mirror, arc, next);
    Lookup guess = Lookup(direction, kUnknown, 1.0, 0.0);
    float guessed_distance = 0.0;
    uint samples = 0u;
    bool is_done = false;
    do { // a loop that tests its condition at the end is faster on the software driver (lib/trace.glsl)
        bool changes = false; // whether a and b differ and are less than a texel apart
        do {
            count_search_step();
            if (do_samples_see_same_surfaces(a, b)) {
                a = b;
                is_done = a.place == arc.end || ++samples > kMaxSearchSamples;
                if (a.place == next && !is_done) {
                    ++step;
                    next = step == steps ? arc.end : vec2(next.x * turn.x - next.y * turn.y, next.x * turn.y + next.y * turn.x);
                }
                if (!is_done) b = sample_layers_on_arc(mirror, arc, next);
            } else if (sine_between(a.place, b.place) > 0.25 * half_texel) {
                ArcSample middle = sample_layers_on_arc(mirror, arc, normalize(a.place + b.place));
                if (do_samples_see_same_surfaces(a, middle)) a = middle;
                else b = middle;
                is_done = ++samples > kMaxSearchSamples;
            } else changes = true;
        } while (!changes && !is_done);
        if (is_done) break;
        float before = inverse_distance_of_next_surface(a);
        Lookup found;
        bool is_lost;
        if (meets_sampled_surface(mirror, arc, a, b, found, is_lost)) return found;
        if (is_lost) {
            guess = Lookup(arc_direction_at(arc, rotate_arc_place(a.place, -2.0 * half_texel)), kUnknown, 1.0, 0.0);
            guessed_distance = 1.0 / before;
        } else if (before == 0.0 && count_surfaces_in_front(b) > count_surfaces_in_front(a)) {
            guess = Lookup(direction, kUnknown, 1.0, kLeaves);
            guessed_distance = 0.0;
        }
        a = b;
        if (++samples > kMaxSearchSamples || a.place == arc.end) break;
        b = sample_layers_on_arc(mirror, arc, next);
    } while (true);
    // The ray met no surface. A ray that left the scene with at most one captured surface in front is a miss. Any other
    // ray was lost behind two surfaces that face the centre.
    uint count = count_surfaces_in_front(a);
    if (count < 2u) return Lookup(direction, kMiss, 0.0, float(count));
    found_distance = guessed_distance;
    return guess;
}
#include "lib/mirror.glsl"
