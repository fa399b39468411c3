// A mirror that looks its reflection up in captures. The including shader (one for each technique)
// defines, before it includes this,
//   Lookup search(uint mirror, vec3 offset, vec3 direction)
// where in capture `mirror` (from 0) to find what arrives against `direction` (unit) at the point
// `offset` from the capture's centre, scene units.
#ifndef CATOPTRIC_MIRROR_GLSL
#define CATOPTRIC_MIRROR_GLSL

#include "lib/constants.glsl"
#include "lib/next_mirror.glsl"
#include "lib/probe.glsl"
#include "lib/surface.glsl"
#ifdef LIT
#include "lib/lit.glsl"
#endif

// Other mirrors that the reflected ray is followed through. Exact spheres are met before the search, where a
// test of the ray costs no fetch; those of any other shape where a search ends on them.
layout(constant_id = HOPS_CONSTANT) const uint hops = 0u;
// 1: captures keep number and normal of their surfaces; always where some mirror is no exact sphere.
layout(constant_id = HAS_SURFACES_CONSTANT) const uint has_surfaces = 0u;
// 1: where a mirror's own capture does not know, those of the others are asked.
layout(constant_id = ASKS_OTHERS_CONSTANT) const uint asks_others = 0u;
const uint kShowColour = 0u, kShowState = 1u, kShowResidual = 2u;
layout(constant_id = SHOW_CONSTANT) const uint show = kShowColour;

// The number of the tracing that takes over where the search ends unknown; 0: none does.
layout(constant_id = TRACER_CONSTANT) const uint tracer = 0u;
// 1: it takes over everywhere, no answer is believed.
layout(constant_id = TRUSTS_NONE_CONSTANT) const uint trusts_none = 0u;

// The reflected ray that is looked up: it leaves mirror `mirror` (from 0) at `at`.
struct Path {
    uint mirror;
    vec3 at;
    vec3 direction; // unit
    vec3 centre;    // of the mirror's capture
    vec3 weight;    // reflectances on the way from the eye
    uint hops;      // mirrors met after the one that is drawn
};

bool is_mirror(vec4 surface) { return surface.x > 0.0; }
vec4 captured_surface(uint mirror, vec3 direction) {
#define SURFACE(i) textureLod(SURFACE_CUBES(i), vec4(direction, cube_of(mirror)), 0)
    RETURN_OF_ARRAY(mirror, SURFACE)
}

// Of a ray that meets the mirror. A mirror without a capture is black where others show it.
vec3 reflectance_of(uint mirror, vec3 direction, vec3 n) {
    if (!is_captured(mirror)) return vec3(0);
    vec3 reflectance = probe_at(mirror).reflectance;
    bool is_metal = details != 0u && probe_at(mirror).kind == kProbeMetal;
    return is_metal ? schlick(reflectance, vec3(1), abs(dot(n, direction))) : reflectance;
}

// On from the exact sphere that the ray meets next, if there is one in sight.
bool follow_sphere(inout Path path) {
    uint next;
    float t;
    Ray ray = Ray(path.at, path.direction, 0u);
    if (!first_sphere(ray, path.mirror, next, t)) return false;
    vec3 error;
    vec3 met = sphere_point(probe_at(next).sphere, probe_at(next).radius, ray, t, error);
    // Something that stands more than the sphere's radius in front of it hides it.
    vec3 seen = met - path.centre;
    if (captured_distance(path.mirror, normalize(seen)) + probe_at(next).radius < length(seen)) return false;
    vec3 n = (met - probe_at(next).sphere) / probe_at(next).radius;
    path = Path(next, met, mirror_direction(path.direction, n, n), probe_at(next).centre,
                path.weight * reflectance_of(next, path.direction, n), path.hops + 1u);
    return true;
}

// On from a mirror of any shape that the search ended on: from where the ray meets its tangent plane.
bool follow_captured(inout Path path, Lookup lookup) {
    vec4 surface = captured_surface(path.mirror, lookup.direction);
    if (lookup.state != kHit || lookup.layer != 0.0 || !is_mirror(surface)) return false;
    uint next = uint(surface.x) - 1u;
    if (probe_at(next).radius > 0.0) return false; // an exact sphere that the ray is known to miss
    if (details != 0u && probe_at(next).kind == kProbeLit) return false; // only the capture knows its own light
    vec3 n = normalize(surface.yzw);
    vec3 seen = path.centre + lookup.direction * captured_distance(path.mirror, lookup.direction);
    float t = dot(seen - path.at, n) / dot(path.direction, n);
    if (!(is_finite(t) && t > 0.0)) return false;
    path = Path(next, path.at + path.direction * t, mirror_direction(path.direction, n, n), probe_at(next).centre,
                path.weight * reflectance_of(next, path.direction, n), path.hops + 1u);
    return true;
}

#ifndef OWN_LOOKUP_COLOUR // the including shader's own, where captures hold more than one colour
vec3 lookup_colour(uint mirror, Lookup lookup) { return found_colour(mirror, lookup); }
// How far from the centre the last search, or whoever sets it, looks.
float last_hit_distance() { return 0.0; }
void set_last_hit_distance(float distance) {}
#endif

// How far along the path a search in capture `mirror` ends.
float end_of(uint mirror, Path path, Lookup lookup) {
    float distance = last_hit_distance() > 0.0 ? last_hit_distance() : captured_distance(mirror, lookup.direction);
    vec3 end = probe_at(mirror).centre + lookup.direction * distance;
    return lookup.state == kMiss ? kLargest : dot(end - path.at, path.direction);
}

// Where another capture knows how the ray ends, if one does. What a mirror shows there is for another eye.
void fall_back_to_other_captures(inout Path path, inout Lookup lookup) {
    float distance = last_hit_distance();
    Ray ray = Ray(path.at, path.direction, 0u);
    // The first mirror that the ray meets, or may, is the same whoever is asked.
    uint first;
    float met;
    bool meets = mirror_tree != 0u && first_by_tree(ray, path.mirror, false, first, met);
    uint next = 0u, count = frame.value.mirror_count;
    do { // loops ask at their end: see lib/trace.glsl
        uint i = next++;
        if (i == path.mirror || !is_captured(i)) continue;
        Lookup other = search(i, path.at - probe_at(i).centre, path.direction);
        if (other.state == kUnknown || is_mirror(captured_surface(i, other.direction))) continue;
        float end = end_of(i, path, other);
        if (mirror_tree != 0u ? meets && !(end < met) : meets_mirror_before(ray, path.mirror, end)) continue;
        path.mirror = i;
        path.centre = probe_at(i).centre;
        lookup = other;
        return;
    } while (next < count);
    set_last_hit_distance(distance);
}

// The path's end and where it is to be looked up.
Lookup follow(inout Path path) {
    Lookup lookup;
    bool goes_on;
    do {
#ifdef CONTINUE
        while (path.hops < hops && follow_sphere(path)) {}
#endif
        lookup = search(path.mirror, path.at - path.centre, path.direction);
        goes_on = false;
#ifdef CONTINUE
        if (has_surfaces != 0u && path.hops < hops) goes_on = follow_captured(path, lookup);
#endif
    } while (goes_on);
#ifdef CONTINUE
    if (asks_others != 0u && lookup.state == kUnknown) fall_back_to_other_captures(path, lookup);
#endif
    return lookup;
}

vec3 shown(vec3 colour, Lookup lookup) {
    if (show == kShowResidual) return vec3(lookup.residual);
    if (show == kShowState)
        return lookup.state == kHit ? vec3(0.1, 0.6, 0.2) : lookup.state == kUnknown ? vec3(0.9, 0.3, 0.1) : vec3(0.1, 0.2, 0.8);
    return colour;
}

#ifdef ABLATE
#include "lib/ablate.glsl"
#endif

void main() {
    vec3 facet = normalize(cross(dFdx(from_eye), dFdy(from_eye)));
#ifdef PEEL
    if (is_peeled()) discard; // not before the derivatives
#endif
    leave_out_what_is_cut();
    vec3 n = normalize(normal);
    Surface surface = surface_here(n, facet);
    Path path = Path(drawn_mirror() - 1u, surface_position(), mirror_direction(normalize(seen_along()), n, facet),
                     probe_at(drawn_mirror() - 1u).centre, surface.reflectance, 0u);
    Lookup lookup = follow(path);
#ifdef ABLATE
    vec3 colour = ablated_radiance(path, lookup);
#else
    vec3 colour = path.weight * lookup_colour(path.mirror, lookup);
#ifdef LIT
    colour += shade(surface, surface_position(), n, lit_facet(surface.detail, facet));
#endif
#endif
    write_surface(shown(colour, lookup));
    if (tracer != 0u && (trusts_none != 0u || lookup.state == kUnknown)) out_distance = float(tracer);
    if (keeps_surface == 0u)
        out_more = vec4(lookup.direction, float(1u + lookup.state) + 4.0 * lookup.layer + 8.0 * float(path.mirror) +
                                              clamp(lookup.residual, 0.0, 0.996)); // below one at 8 bits of mirror
}

#endif
