// Part of lib/math.glsl, which alone includes it.
// Rays that leave a surface: no world epsilon, only bounds of the roundings made.

// Unit normal of the facet, counter-clockwise side; zero when it has none.
INLINE vec3 facet_normal(vec3 a, vec3 b, vec3 c) {
    vec3 e, f;
    short_edges(a, b, c, e, f);
    real e_size = largest(abs(e));
    real f_size = largest(abs(f));
    if (!(e_size > real(0) && f_size > real(0))) return vec3(real(0));
    // Scaled first, so that tiny triangles do not underflow.
    vec3 n = cross(e / e_size, f / f_size);
    real size = length(n);
    return size > real(0) ? n / size : vec3(real(0));
}

// The point with barycentric weights w, and how far each coordinate may be off: the interpolation's
// roundings, plus those of a triangle test that starts here. A flat triangle cannot be met by a ray
// that leaves it, so Ray::leaves excludes it by name; the bound is for its neighbours in the same
// plane, and for copies of it.
INLINE vec3 triangle_point(vec3 a, vec3 b, vec3 c, vec3 w, OUT(vec3) error) {
    vec3 point = w.x * a + w.y * b + w.z * c;
    vec3 sum = abs(w.x * a) + abs(w.y * b) + abs(w.z * c);
    vec3 reach = max(abs(a - point), max(abs(b - point), abs(c - point)));
    error = gamma_bound(7) * sum + gamma_bound(32) * vec3(largest(reach));
    return point;
}

// How far above a place of a triangle, by its weights w, a smooth surface is that has these normals at its corners:
// the mean height of the planes across them (Hanika, "Hacking the shadow terminator", Ray Tracing Gems II, 2021).
// A curved body lies between this and half of it; a hollow one below the facet: 0.
INLINE real smooth_lift(vec3 a, vec3 b, vec3 c, vec3 n_a, vec3 n_b, vec3 n_c, vec3 w) {
    vec3 point = w.x * a + w.y * b + w.z * c;
    vec3 heights = vec3(dot(a - point, n_a), dot(b - point, n_b), dot(c - point, n_c));
    return dot(w, max(heights, vec3(real(0))));
}

// The same for a hit on a sphere; the point is put back onto the surface.
INLINE vec3 sphere_point(vec3 centre, real radius, Ray ray, real t, OUT(vec3) error) {
    vec3 arm = (ray.origin - centre) + t * ray.direction;
    vec3 on_sphere = arm * (radius / length(arm));
    vec3 point = centre + on_sphere;
    error = gamma_bound(3) * abs(point) + vec3(gamma_bound(16) * radius);
    return point;
}

// Where a ray that leaves `point` along `direction` starts: off the surface by the error bound
// projected on its normal, then each coordinate one float further.
INLINE vec3 spawn_origin(vec3 point, vec3 error, vec3 n_geometric, vec3 direction) {
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
