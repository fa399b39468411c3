// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Origins of rays that leave a surface. Bounds of the rounding errors replace an epsilon in world units.

// Returns the unit normal of a triangle on its counter-clockwise side, or zero if the triangle is degenerate.
INLINE vec3 facet_normal(vec3 a, vec3 b, vec3 c) {
    vec3 e, f;
    choose_shorter_edges(a, b, c, e, f);
    real e_size = largest_vector_component(abs(e));
    real f_size = largest_vector_component(abs(f));
    if (!(e_size > real(0) && f_size > real(0))) return vec3(real(0));
    // The edges are scaled first, so that the cross product of a tiny triangle does not underflow.
    vec3 n = cross(e / e_size, f / f_size);
    real size = length(n);
    return size > real(0) ? n / size : vec3(real(0));
}

// Returns the point of a triangle with barycentric weights `w`, and a bound of the error of each coordinate. The bound
// covers the roundings of the interpolation, and those of a triangle test for a ray that starts at the point.
// The triangle itself is excluded by Ray::leaves. The bound is for its copies and for neighbours in the same plane.
INLINE vec3 triangle_hit_point(vec3 a, vec3 b, vec3 c, vec3 w, OUT(vec3) error) {
    vec3 point = w.x * a + w.y * b + w.z * c;
    vec3 sum = abs(w.x * a) + abs(w.y * b) + abs(w.z * c);
    vec3 reach = max(abs(a - point), max(abs(b - point), abs(c - point)));
    error = rounding_error_gamma_bound(7) * sum + rounding_error_gamma_bound(32) * vec3(largest_vector_component(reach));
    return point;
}

// Returns the height, above the triangle's point with weights `w`, of a smooth surface with these normals at the
// corners. The height is the weighted mean height of the corners' tangent planes (Hanika, "Hacking the shadow
// terminator", Ray Tracing Gems II, 2021). A convex surface lies between half this height and this height. A hollow
// surface lies below the triangle and gets height 0.
INLINE real smooth_surface_offset(vec3 a, vec3 b, vec3 c, vec3 n_a, vec3 n_b, vec3 n_c, vec3 w) {
    vec3 point = w.x * a + w.y * b + w.z * c;
    vec3 heights = vec3(dot(a - point, n_a), dot(b - point, n_b), dot(c - point, n_c));
    return dot(w, max(heights, vec3(real(0))));
}

// Returns the point of a hit on a sphere, projected back onto the sphere, and a bound of the error of each coordinate.
INLINE vec3 sphere_hit_point(vec3 centre, real radius, Ray ray, real t, OUT(vec3) error) {
    vec3 arm = (ray.origin - centre) + t * ray.direction;
    vec3 on_sphere = arm * (radius / length(arm));
    vec3 point = centre + on_sphere;
    error = rounding_error_gamma_bound(3) * abs(point) + vec3(rounding_error_gamma_bound(16) * radius);
    return point;
}

// Returns the origin of a ray that leaves `point` along `direction`. The origin is moved off the surface by the error
// bound projected on the normal, and then by one more float in each coordinate.
INLINE vec3 ray_spawn_origin(vec3 point, vec3 error, vec3 n_geometric, vec3 direction) {
    vec3 away = dot(direction, n_geometric) < real(0) ? -n_geometric : n_geometric;
    vec3 origin = point + dot(abs(away), error) * away;
    origin.x = away.x > real(0) ? next_up(origin.x)
                                : (away.x < real(0) ? next_down(origin.x) : origin.x);
    origin.y = away.y > real(0) ? next_up(origin.y)
                                : (away.y < real(0) ? next_down(origin.y) : origin.y);
    origin.z = away.z > real(0) ? next_up(origin.z)
                                : (away.z < real(0) ? next_down(origin.z) : origin.z);
    return origin;
}
