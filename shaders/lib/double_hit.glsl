// Hit points in doubles: along rays that are kept in doubles from mirror to mirror and are never moved off a
// surface. What floats decide is which surface is met (lib/trace.glsl), and how it is lit. For measuring what
// single precision costs in accuracy.
#ifndef CATOPTRIC_DOUBLE_HIT_GLSL
#define CATOPTRIC_DOUBLE_HIT_GLSL

#include "lib/math.glsl"

// The ray that is traced, and where it has met a mirror; scene units.
dvec3 exact_origin, exact_direction;
dvec3 exact_point, exact_normal, exact_facet;

// `low`: what the ray's origin lacks.
void exact_ray(Ray ray, vec3 low) {
    exact_origin = dvec3(ray.origin) + dvec3(low);
    exact_direction = dvec3(ray.direction);
}

// From a thing's own space (see Place).
dvec3 exact_place(Place place, vec3 own) {
    return dvec3(place.centre) + dvec3(place.centre_low) + double(own.x) * dvec3(place.scene_x) +
           double(own.y) * dvec3(place.scene_y) + double(own.z) * dvec3(place.scene_z);
}
dvec3 exact_scene_normal(Place place, dvec3 own) {
    return own.x * dvec3(place.own_x) + own.y * dvec3(place.own_y) + own.z * dvec3(place.own_z);
}

// Where the ray meets the triangle that the floats say it meets, at about the barycentric weights `w`. Returns
// the weights; sets point and facet.
dvec3 exact_triangle_hit(dvec3 a, dvec3 b, dvec3 c, vec3 w) {
    dvec3 e = b - a, f = c - a, n = cross(e, f);
    double size = dot(n, n), slope = dot(n, exact_direction);
    exact_facet = n / sqrt(size);
    dvec3 from_a = exact_origin - a, at = double(w.y) * e + double(w.z) * f;
    if (slope != 0.0LF) at = from_a - dot(n, from_a) / slope * exact_direction; // else seen edge on
    exact_point = a + at;
    double v = dot(cross(at, f), n) / size, u = dot(cross(e, at), n) / size;
    return dvec3(1.0LF - v - u, v, u);
}

// The same for a sphere, at about t. Sets point, normal and facet.
void exact_sphere_hit(dvec3 centre, double radius, float t) {
    dvec3 arm = exact_origin - centre + double(t) * exact_direction;
    // Newton's steps from the float's t; where the ray grazes they lead nowhere.
    for (int i = 0; i < 2; ++i) {
        double slope = dot(arm, exact_direction);
        if (abs(slope) < 1e-3LF * radius * length(exact_direction)) break;
        arm -= (dot(arm, arm) - radius * radius) / (slope + slope) * exact_direction;
    }
    exact_facet = exact_normal = normalize(arm);
    exact_point = centre + radius * exact_normal;
}

// As mirror_direction; the reflected ray starts in the point itself.
vec3 exact_reflection() {
    dvec3 facet = dot(exact_direction, exact_facet) > 0.0LF ? -exact_facet : exact_facet;
    dvec3 r = exact_direction - 2.0LF * dot(exact_direction, exact_normal) * exact_normal;
    double height = dot(r, facet);
    exact_origin = exact_point;
    exact_direction = height < 0.0LF ? normalize(r - 2.0LF * height * facet) : r;
    return vec3(exact_direction);
}

#endif
