// Computes hit points in double precision, to measure how much accuracy single precision loses. The ray stays in
// doubles from mirror to mirror, and its origin is never moved off a surface. Single precision still decides which
// surface the ray meets (lib/trace.glsl) and how the surface is lit.
#ifndef CATOPTRIC_DOUBLE_HIT_GLSL
#define CATOPTRIC_DOUBLE_HIT_GLSL

#include "lib/math.glsl"

// The traced ray, and the point, shading normal and facet normal at its last hit, in scene units.
dvec3 exact_origin, exact_direction;
dvec3 exact_point, exact_normal, exact_facet;

// Sets the traced ray. `low` is the rounding error of the ray's origin: the exact origin is origin + low.
void set_double_precision_ray(Ray ray, vec3 low) {
    exact_origin = dvec3(ray.origin) + dvec3(low);
    exact_direction = dvec3(ray.direction);
}

// Transforms a position from an instance's object space to scene units (see ObjectPlacement).
dvec3 transform_exact_position_to_scene(ObjectPlacement place, vec3 own) {
    return dvec3(place.centre) + dvec3(place.centre_low) + double(own.x) * dvec3(place.scene_x) +
           double(own.y) * dvec3(place.scene_y) + double(own.z) * dvec3(place.scene_z);
}
dvec3 transform_exact_normal_to_scene(ObjectPlacement place, dvec3 own) {
    return own.x * dvec3(place.own_x) + own.y * dvec3(place.own_y) + own.z * dvec3(place.own_z);
}

// Intersects the ray with the triangle that the single precision walk found, near the barycentric weights `w`. Returns
// the exact weights, and sets exact_point and exact_facet.
dvec3 refine_exact_triangle_hit(dvec3 a, dvec3 b, dvec3 c, vec3 w) {
    dvec3 e = b - a, f = c - a, n = cross(e, f);
    double size = dot(n, n), slope = dot(n, exact_direction);
    exact_facet = n / sqrt(size);
    dvec3 from_a = exact_origin - a, at = double(w.y) * e + double(w.z) * f;
    // Slope 0: the ray sees the triangle edge-on, and the point is not refined.
    if (slope != 0.0LF) at = from_a - dot(n, from_a) / slope * exact_direction;
    exact_point = a + at;
    double v = dot(cross(at, f), n) / size, u = dot(cross(e, at), n) / size;
    return dvec3(1.0LF - v - u, v, u);
}

// Intersects the ray with a sphere near the ray parameter `t`. Sets exact_point, exact_normal and exact_facet.
void refine_exact_sphere_hit(dvec3 centre, double radius, float t) {
    dvec3 arm = exact_origin - centre + double(t) * exact_direction;
    // Newton iteration from the single precision t. Where the ray grazes the sphere, the iteration does not converge.
    for (int i = 0; i < 2; ++i) {
        double slope = dot(arm, exact_direction);
        if (abs(slope) < 1e-3LF * radius * length(exact_direction)) break;
        arm -= (dot(arm, arm) - radius * radius) / (slope + slope) * exact_direction;
    }
    exact_facet = exact_normal = normalize(arm);
    exact_point = centre + radius * exact_normal;
}

// Reflects the ray as reflect_above_facet does. The reflected ray starts exactly at exact_point. Returns its direction.
vec3 reflect_exact_ray() {
    dvec3 facet = dot(exact_direction, exact_facet) > 0.0LF ? -exact_facet : exact_facet;
    dvec3 r = exact_direction - 2.0LF * dot(exact_direction, exact_normal) * exact_normal;
    double height = dot(r, facet);
    exact_origin = exact_point;
    exact_direction = height < 0.0LF ? normalize(r - 2.0LF * height * facet) : r;
    return vec3(exact_direction);
}

#endif
