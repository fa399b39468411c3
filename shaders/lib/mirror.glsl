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

// The reflected ray that is looked up: it leaves mirror `mirror` (from 0) at `at`.
struct Path {
    uint mirror;
    vec3 at;
    vec3 direction; // unit
    vec3 centre;    // of the mirror's capture
    vec3 weight;    // reflectances on the way from the eye
    uint hops;      // mirrors met after the one that is drawn
};

// The nearest other mirror along the ray, if it is an exact sphere.
bool next_mirror(Path path, out uint next, out float t) {
    bool found = false;
    t = kLargest;
    for (uint i = 0u; i < frame.value.mirror_count; ++i) {
        float t_sphere;
        if (i != path.mirror && probes[i].radius > 0.0 &&
            sphere_test(probes[i].sphere, probes[i].radius, Ray(path.at, path.direction, 0u), t, t_sphere)) {
            t = t_sphere;
            next = i;
            found = true;
        }
    }
    return found;
}

// On from the exact sphere that the ray meets next, if there is one in sight.
bool follow_sphere(inout Path path) {
    uint next;
    float t;
    if (!next_mirror(path, next, t)) return false;
    vec3 error;
    vec3 met = sphere_point(probes[next].sphere, probes[next].radius, Ray(path.at, path.direction, 0u), t, error);
    // Something that stands more than the sphere's radius in front of it hides it.
    vec3 seen = met - path.centre;
    if (captured_distance(path.mirror, normalize(seen)) + probes[next].radius < length(seen)) return false;
    vec3 n = (met - probes[next].sphere) / probes[next].radius;
    path = Path(next, met, mirror_direction(path.direction, n, n), probes[next].centre,
                path.weight * probes[next].reflectance, path.hops + 1u);
    return true;
}

#ifndef OWN_LOOKUP_COLOUR // the including shader's own, where captures hold more than one colour
vec3 lookup_colour(uint mirror, Lookup lookup) { return found_colour(mirror, lookup); }
void look_at(float distance) {}
#endif

#ifdef MEND
#include "lib/mend.glsl"
#endif

void main() {
    vec3 facet = normalize(cross(dFdx(from_eye), dFdy(from_eye)));
#ifdef PEEL
    if (is_peeled()) discard; // not before the derivatives
#endif
    Path path = Path(draw.surface.mirror - 1u, position, mirror_direction(normalize(from_eye), normalize(normal), facet),
                     draw.probe_centre, draw.surface.reflectance, 0u);
#ifdef CONTINUE
    while (path.hops < hops && follow_sphere(path)) {}
#endif
    Lookup lookup = search(path.mirror, path.at - path.centre, path.direction);
#ifdef MEND
    write_surface(mended_radiance(path, lookup));
#else
    write_surface(path.weight * lookup_colour(path.mirror, lookup));
#endif
    out_lookup = vec4(lookup.direction, float(1u + lookup.state) + 4.0 * lookup.layer + 8.0 * float(path.mirror));
}

#endif
