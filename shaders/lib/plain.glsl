// Common, less robust methods of ray tracers, to measure the cost and the benefit of each of this tracer's robustness
// rules (docs/robustness.md). `without` is the number of the rule that a common method replaces; 0 keeps all rules.
#ifndef CATOPTRIC_PLAIN_GLSL
#define CATOPTRIC_PLAIN_GLSL

#include "lib/constants.glsl"
#include "lib/math.glsl"

// Numbers of the robustness rules, in the order of the `without` knob of technique `raytrace`.
const uint kWatertightRule = 1u, kBoxPaddingRule = 2u, kOriginErrorBoundRule = 3u, kShadowRayEndRule = 4u,
    kStableSphereRule = 5u;
layout(constant_id = WITHOUT_CONSTANT) const uint without = 0u;
// Offset off a surface without kOriginErrorBoundRule, scene units.
layout(constant_id = FIXED_OFFSET_CONSTANT) const float fixed_offset = 0.0;

bool is_precision_rule_kept(uint rule) { return without != rule; }

// Intersects a ray with a triangle (Moeller and Trumbore 1997), without an epsilon.
bool plain_triangle_test(vec3 a, vec3 b, vec3 c, Ray ray, out float t, out vec3 weights) {
    vec3 e = b - a, f = c - a;
    vec3 p = cross(ray.direction, f);
    float det = dot(e, p);
    vec3 from_a = ray.origin - a;
    vec3 q = cross(from_a, e);
    float v = dot(from_a, p) / det, w = dot(ray.direction, q) / det;
    t = dot(f, q) / det;
    weights = vec3(1.0 - v - w, v, w);
    return v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t > 0.0 && t <= kLargestFloat;
}

BoxTestRay make_plain_box_ray(Ray ray) { return BoxTestRay(ray.origin, ray.origin, 1.0 / ray.direction); }

// Intersects a ray with a box by slabs (Kay and Kajiya 1986).
bool plain_slab_test(vec3 lo, vec3 hi, BoxTestRay ray, float t_max, out float t_near) {
    vec3 t_lo = (lo - ray.near_origin) * ray.inverse, t_hi = (hi - ray.near_origin) * ray.inverse;
    vec3 enter = min(t_lo, t_hi), leave = max(t_lo, t_hi);
    t_near = max(0.0, largest_vector_component(enter));
    return t_near <= min(t_max, min(leave.x, min(leave.y, leave.z)));
}

// Intersects a ray with a sphere by the textbook quadratic formula.
bool plain_sphere_test(vec3 centre, float radius, Ray ray, float t_max, out float t) {
    vec3 f = ray.origin - centre;
    float a = dot(ray.direction, ray.direction), half_b = dot(f, ray.direction);
    float quarter = half_b * half_b - a * (dot(f, f) - radius * radius);
    t = 0.0;
    if (!(quarter >= 0.0)) return false;
    float root = sqrt(quarter);
    float first = (-half_b - root) / a, second = (-half_b + root) / a;
    t = first > 0.0 ? first : second;
    return t > 0.0 && t < t_max;
}

vec3 plain_ray_spawn_origin(vec3 point, vec3 n_geometric, vec3 direction) {
    return point + (dot(direction, n_geometric) < 0.0 ? -fixed_offset : fixed_offset) * n_geometric;
}

#endif
