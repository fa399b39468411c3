// A mirror that looks its reflection up in captures. The including shader (one for each technique)
// defines, before it includes this,
//   Lookup search(uint mirror, vec3 offset, vec3 direction)
// where in capture `mirror` (from 0) to find what arrives against `direction` (unit) at the point
// `offset` from the capture's centre, scene units.
#ifndef CATOPTRIC_MIRROR_GLSL
#define CATOPTRIC_MIRROR_GLSL

#include "lib/probe.glsl"
#include "lib/surface.glsl"

// Mirrors that the reflected ray is followed through before the search: only those that are exact
// spheres, where a test of the ray costs no fetch.
layout(constant_id = 3) const uint hops = 0u;

// The nearest other mirror along the ray, if it is an exact sphere.
bool next_mirror(uint mirror, vec3 at, vec3 direction, out uint next, out float t) {
    bool found = false;
    t = kLargest;
    for (uint i = 0u; i < frame.value.mirror_count; ++i) {
        float t_sphere;
        if (i != mirror && probes[i].radius > 0.0 &&
            sphere_test(probes[i].sphere, probes[i].radius, Ray(at, direction, 0u), t, t_sphere)) {
            t = t_sphere;
            next = i;
            found = true;
        }
    }
    return found;
}

#ifndef OWN_LOOKUP_COLOUR // the including shader's own, where captures hold more than one colour
vec3 lookup_colour(uint mirror, Lookup lookup) { return found_colour(mirror, lookup); }
#endif

void main() {
    uint mirror = draw.surface.mirror - 1u;
    vec3 facet = normalize(cross(dFdx(from_eye), dFdy(from_eye)));
#ifdef PEEL
    if (is_peeled()) discard; // not before the derivatives
#endif
    vec3 direction = mirror_direction(normalize(from_eye), normalize(normal), facet);
    vec3 weight = draw.surface.reflectance;
    vec3 at = position;
    vec3 centre = draw.probe_centre;
#ifdef CONTINUE
    for (uint hop = 0u; hop < hops; ++hop) {
        uint next;
        float t;
        if (!next_mirror(mirror, at, direction, next, t)) break;
        vec3 error;
        vec3 met = sphere_point(probes[next].sphere, probes[next].radius, Ray(at, direction, 0u), t, error);
        // Something that stands more than the sphere's radius in front of it hides it.
        vec3 seen = met - centre;
        if (captured_distance(mirror, normalize(seen)) + probes[next].radius < length(seen)) break;
        vec3 n = (met - probes[next].sphere) / probes[next].radius;
        weight *= probes[next].reflectance;
        direction = mirror_direction(direction, n, n);
        at = met;
        mirror = next;
        centre = probes[next].centre;
    }
#endif
    Lookup lookup = search(mirror, at - centre, direction);
    write_surface(weight * lookup_colour(mirror, lookup));
    out_lookup = vec4(lookup.direction, float(1u + lookup.state) + 4.0 * lookup.layer + 8.0 * float(mirror));
}

#endif
