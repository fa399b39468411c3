// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Intersection of rays with triangles, boxes and spheres.

struct Ray {
    vec3 origin;
    vec3 direction; // direction of the ray, of any length but zero
    uint leaves;    // 1 + original number of the triangle on which the ray starts; 0: it starts on no triangle
};

INLINE bool is_valid_ray(Ray ray) {
    return is_finite(ray.origin) && is_finite(ray.direction) &&
           largest_vector_component(abs(ray.direction)) > real(0);
}

// The data of a ray for the triangle test (Woop, Benthin, Wald 2013). The coordinates are turned so that the ray's
// dominant axis becomes z, and then sheared so that the ray runs along z.
struct TriangleTestRayShear {
    int axis;   // the ray's dominant axis, 0 to 2
    vec3 shear; // d.x / d.z, d.y / d.z and 1 / d.z of the turned direction d
};

// Permutes the components of a vector cyclically, so that component `axis` comes last.
INLINE vec3 permute_to_axis(vec3 v, int axis) {
    return axis == 2 ? v : (axis == 0 ? vec3(v.y, v.z, v.x) : vec3(v.z, v.x, v.y));
}

INLINE TriangleTestRayShear make_ray_shear(vec3 direction) {
    vec3 size = abs(direction);
    TriangleTestRayShear result;
    result.axis = size.z >= size.x && size.z >= size.y ? 2 : (size.y >= size.x ? 1 : 0);
    precise vec3 d = permute_to_axis(direction, result.axis);
    precise real x = d.x / d.z;
    precise real y = d.y / d.z;
    result.shear = vec3(x, y, real(1) / d.z);
    return result;
}

// Returns the rounding error of the product a * b, exactly, unless a product overflows or underflows (Dekker 1971, with
// Veltkamp's split).
INLINE real product_rounding_error(real a, real b) {
    precise real ta = kSplitter * a;
    precise real tb = kSplitter * b;
    precise real a_high = ta - (ta - a);
    precise real b_high = tb - (tb - b);
    precise real a_low = a - a_high;
    precise real b_low = b - b_high;
    precise real product = a * b;
    precise real high = (a_high * b_high - product) + a_high * b_low + a_low * b_high;
    precise real error = high + a_low * b_low;
    return error;
}

// Returns a * b - c * d with the exact sign, unless a product overflows or underflows. Rounding is monotone, so only a
// difference of exactly 0 can have lost its sign. In this case the rounding errors of the products give the sign.
INLINE real exact_product_difference(real a, real b, real c, real d) {
    precise real difference = a * b - c * d;
    if (difference == real(0)) {
        precise real rest = product_rounding_error(a, b) - product_rounding_error(c, d);
        difference = rest;
    }
    return difference;
}

// Returns the smaller (or larger) of two values, or `kept` if the candidate is NaN. A ray in the plane of a box's face
// gives the candidate 0 * infinity, which is NaN.
INLINE real nan_safe_min(real kept, real candidate) { return candidate < kept ? candidate : kept; }
INLINE real nan_safe_max(real kept, real candidate) { return candidate > kept ? candidate : kept; }

// Computes the two shorter edges `e` and `f` of a triangle, because their rounding errors tilt its plane least. Returns
// the corner between the two edges: 0, 1 or 2. cross(e, f) points to the counter-clockwise side.
INLINE int choose_shorter_edges(vec3 a, vec3 b, vec3 c, OUT(vec3) e, OUT(vec3) f) {
    precise vec3 ab = b - a;
    precise vec3 bc = c - b;
    precise vec3 ca = a - c;
    real ab_size = largest_vector_component(abs(ab));
    real bc_size = largest_vector_component(abs(bc));
    real ca_size = largest_vector_component(abs(ca));
    bool ab_longest = ab_size >= bc_size && ab_size >= ca_size;
    bool bc_longest = !ab_longest && bc_size >= ca_size;
    e = ab_longest ? bc : (bc_longest ? ca : ab);
    f = ab_longest ? ca : (bc_longest ? ab : bc);
    return ab_longest ? 2 : (bc_longest ? 0 : 1);
}

// Watertight triangle test. Returns whether the ray meets the triangle from either side at a finite t > 0. The weights,
// divided by their sum, are the barycentric weights of a, b, c (see `normalise_barycentric`).
INLINE bool intersect_triangle_watertight(vec3 a, vec3 b, vec3 c, vec3 origin, TriangleTestRayShear ray, OUT(real) t,
                          OUT(vec3) weights) {
    precise vec3 ta = permute_to_axis(a - origin, ray.axis);
    precise vec3 tb = permute_to_axis(b - origin, ray.axis);
    precise vec3 tc = permute_to_axis(c - origin, ray.axis);
    precise real ax = ta.x - ray.shear.x * ta.z;
    precise real ay = ta.y - ray.shear.y * ta.z;
    precise real bx = tb.x - ray.shear.x * tb.z;
    precise real by = tb.y - ray.shear.y * tb.z;
    precise real cx = tc.x - ray.shear.x * tc.z;
    precise real cy = tc.y - ray.shear.y * tc.z;
    precise real u = exact_product_difference(cx, by, cy, bx);
    precise real v = exact_product_difference(ax, cy, ay, cx);
    precise real w = exact_product_difference(bx, ay, by, ax);
    t = real(0);
    weights = vec3(u, v, w);
    bool inside = (u >= real(0) && v >= real(0) && w >= real(0)) ||
                  (u <= real(0) && v <= real(0) && w <= real(0));
    precise real det = u + v + w;
    if (!inside || det == real(0)) return false;
    // Computes t from the triangle's plane. In a triangle that is a thousand times longer than high, t from the
    // barycentric weights would have a thousand times the error.
    vec3 e, f;
    int between = choose_shorter_edges(a, b, c, e, f);
    vec3 corner = between == 0 ? ta : (between == 1 ? tb : tc);
    precise vec3 normal = permute_to_axis(vec3(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z,
                                      e.x * f.y - e.y * f.x), ray.axis);
    precise real height = normal.x * corner.x + normal.y * corner.y + normal.z * corner.z;
    precise real slope = normal.x * ray.shear.x + normal.y * ray.shear.y + normal.z;
    // If the plane is seen edge-on within rounding errors, t from the plane is arbitrary, so the weights give t.
    real doubt = rounding_error_gamma_bound(64) * (abs(normal.x * ray.shear.x) + abs(normal.y * ray.shear.y) + abs(normal.z));
    precise vec3 at = ray.shear.z * vec3(ta.z, tb.z, tc.z);
    precise real at_weights = (u * at.x + v * at.y + w * at.z) / det;
    precise real at_plane = abs(slope) > doubt ? ray.shear.z * (height / slope) : at_weights;
    // Clamps t to the range between the nearest and the farthest corner. For a triangle without a normal, t from the
    // plane is NaN or infinite.
    real first = min(at.x, min(at.y, at.z));
    t = nan_safe_min(largest_vector_component(at), nan_safe_max(first, at_plane));
    return t > real(0) && t <= kLargestFloat;
}

// Returns whether a ray comes from behind a triangle, so that the corners run clockwise as seen along the ray.
INLINE bool hits_back_face(vec3 a, vec3 b, vec3 c, vec3 direction) {
    return dot(cross(b - a, c - a), direction) > real(0);
}

INLINE vec3 normalise_barycentric(vec3 weights) {
    precise real det = weights.x + weights.y + weights.z;
    return weights / det;
}

// The data of a ray for the box test. The triangle test has rounding errors relative to the ray's distance from the
// vertices. The origins are moved by as much, so that the ray meets the box of every triangle that the triangle test
// accepts (Woop et al. 2013, section 4).
struct BoxTestRay {
    vec3 near_origin; // moved origin of the ray, for the planes where the ray enters a box
    vec3 far_origin;  // moved origin of the ray, for the planes where the ray leaves a box
    vec3 inverse;     // 1 / direction, infinite for a component 0
};

// Prepares a ray for box tests. `lo` and `hi` bound the geometry that the ray may meet. Boxes of geometry outside these
// bounds are widened when the tree is built (engine/bvh/bvh.cpp). `times` is the factor by which boxes are widened for
// instances below them (engine/bvh/tlas.hpp), else 1.
INLINE BoxTestRay make_box_ray(Ray ray, vec3 lo, vec3 hi, real times) {
    real reach = largest_vector_component(max(abs(lo - ray.origin), abs(hi - ray.origin)));
    real slack = rounding_error_gamma_bound(16) * reach * times;
    BoxTestRay result;
    result.inverse = vec3(real(1)) / ray.direction;
    vec3 step = vec3(result.inverse.x < real(0) ? -slack : slack,
                     result.inverse.y < real(0) ? -slack : slack,
                     result.inverse.z < real(0) ? -slack : slack);
    result.near_origin = ray.origin + step;
    result.far_origin = ray.origin - step;
    return result;
}

// Returns whether the ray meets the box at a t in [0, t_max]. The ray enters the box at t_near.
INLINE bool intersect_box_slabs(vec3 lo, vec3 hi, BoxTestRay ray, real t_max, OUT(real) t_near) {
    bool back_x = ray.inverse.x < real(0);
    bool back_y = ray.inverse.y < real(0);
    bool back_z = ray.inverse.z < real(0);
    vec3 enter = vec3(back_x ? hi.x : lo.x, back_y ? hi.y : lo.y, back_z ? hi.z : lo.z);
    vec3 leave = vec3(back_x ? lo.x : hi.x, back_y ? lo.y : hi.y, back_z ? lo.z : hi.z);
    vec3 t_enter = (enter - ray.near_origin) * ray.inverse;
    vec3 t_leave = (leave - ray.far_origin) * ray.inverse;
    t_near = nan_safe_max(nan_safe_max(nan_safe_max(real(0), t_enter.x), t_enter.y), t_enter.z);
    real t_far = nan_safe_min(nan_safe_min(nan_safe_min(t_max, t_leave.x), t_leave.y), t_leave.z);
    return t_near <= t_far * (real(1) + real(2) * rounding_error_gamma_bound(3));
}

// Computes the nearest t in (0, t_max) at which the ray meets the sphere from outside or inside. The formula avoids the
// difference of nearly equal squares (Haines, Gunther, Akenine-Moller 2019).
INLINE bool intersect_sphere_robustly(vec3 centre, real radius, Ray ray, real t_max, OUT(real) t) {
    vec3 f = ray.origin - centre;
    real a = dot(ray.direction, ray.direction);
    real b = -dot(f, ray.direction);
    vec3 closest = f + b / a * ray.direction;
    real gap = length(closest);
    real quarter = (radius - gap) * (radius + gap);
    t = real(0);
    if (!(quarter >= real(0))) return false;
    real root = sqrt(a) * sqrt(quarter);
    real q = b < real(0) ? b - root : b + root;
    real size = length(f);
    real t0 = (size - radius) * (size + radius) / q;
    real t1 = q / a;
    real first = t0 < t1 ? t0 : t1;
    real second = t0 < t1 ? t1 : t0;
    t = first > real(0) ? first : second;
    return t > real(0) && t < t_max;
}
