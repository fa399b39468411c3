// Pure mathematics of both worlds: no textures, no globals. Compiled as GLSL, as C++ float and as
// C++ double (engine/core/shader_math.hpp). Comparisons are written so that NaN is a miss.
#if !defined(CATOPTRIC_MATH_GLSL) || defined(__cplusplus)
#define CATOPTRIC_MATH_GLSL

#ifndef __cplusplus
#define real float
#define INLINE
#define OUT(type) out type
const real kUnitRoundoff = 5.9604644775390625e-8; // 2^-24
const real kSplitter = 4097.0;                    // 2^12 + 1: halves of a float's 24 bits

real next_up(real x) {
    if (x == 0.0) return uintBitsToFloat(1u);
    return intBitsToFloat(floatBitsToInt(x) + (x > 0.0 ? 1 : -1));
}
real next_down(real x) { return -next_up(-x); }
#endif

const real kLargest = real(3.402823466e38); // of a float: anything above stands for "infinite"
const real kPi = real(3.14159265358979323846);
const real kShadowRayEnd = real(1) - real(1) / real(8192); // shadow rays end this far to the light

// Higham's gamma: relative error bound of n roundings.
INLINE real gamma_bound(int n) {
    return real(n) * kUnitRoundoff / (real(1) - real(n) * kUnitRoundoff);
}

// isnan is asked for by name: shader compilers may turn !(a <= b) into a > b, which NaN answers otherwise.
INLINE bool is_finite(real x) { return !isnan(x) && abs(x) <= kLargest; }
INLINE bool is_finite(vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }
INLINE real largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Distances of a capture: "nothing there" is +infinity.
INLINE bool is_miss(real distance) { return isnan(distance) || distance > kLargest; }

// ---- Light -------------------------------------------------------------------------------------

// The part of a light's contribution that is geometry: max(0, -w.n_l) / t^2 * max(0, n.w), with w
// the direction and t the distance to the light. light_normal zero: no cosine at the light.
// False, factor 0: a cosine is not positive (or the light is at the point): no shadow ray needed.
INLINE bool light_term(vec3 position, vec3 normal, vec3 light_position, vec3 light_normal,
                       OUT(vec3) direction, OUT(real) distance, OUT(real) factor) {
    vec3 to_light = light_position - position;
    distance = length(to_light);
    direction = vec3(real(0));
    factor = real(0);
    if (!(distance > real(0) && distance <= kLargest)) return false;
    direction = to_light / distance;
    real at_light = dot(light_normal, light_normal) > real(0) ? -dot(direction, light_normal)
                                                              : real(1);
    real at_surface = dot(normal, direction);
    if (!(at_light > real(0) && at_surface > real(0))) return false;
    factor = (at_light / distance) * (at_surface / distance);
    return true;
}

// Radiance of a Lambertian surface; `direct` = sum over lights of intensity * factor * visible.
INLINE vec3 lambert(vec3 emission, vec3 albedo, vec3 direct, real ambient) {
    return emission + albedo / kPi * direct + albedo * ambient;
}

// Reflection of the unit direction d about the interpolated normal; where that points below the
// facet (seen from the side d comes from), it is folded back above it.
INLINE vec3 mirror_direction(vec3 d, vec3 n_shading, vec3 n_geometric) {
    vec3 facet = dot(d, n_geometric) > real(0) ? -n_geometric : n_geometric;
    vec3 r = d - real(2) * dot(d, n_shading) * n_shading;
    real height = dot(r, facet);
    return height < real(0) ? normalize(r - real(2) * height * facet) : r;
}

// ---- Rays --------------------------------------------------------------------------------------

struct Ray {
    vec3 origin;
    vec3 direction; // any length but zero
    uint leaves;    // 1 + original number of the triangle it starts on; 0: it starts in space
};

INLINE bool is_valid(Ray ray) {
    return is_finite(ray.origin) && is_finite(ray.direction) &&
           largest(abs(ray.direction)) > real(0);
}

// What the triangle test needs of a ray (Woop, Benthin, Wald 2013): the dominant axis becomes z,
// and the ray is sheared onto it.
struct RayShear {
    int axis;
    vec3 shear; // d.x / d.z, d.y / d.z, 1 / d.z of the turned direction
};

// The vector turned so that component `axis` comes last.
INLINE vec3 turned(vec3 v, int axis) {
    return axis == 2 ? v : (axis == 0 ? vec3(v.y, v.z, v.x) : vec3(v.z, v.x, v.y));
}

INLINE RayShear ray_shear(vec3 direction) {
    vec3 size = abs(direction);
    RayShear result;
    result.axis = size.z >= size.x && size.z >= size.y ? 2 : (size.y >= size.x ? 1 : 0);
    precise vec3 d = turned(direction, result.axis);
    precise real x = d.x / d.z;
    precise real y = d.y / d.z;
    result.shear = vec3(x, y, real(1) / d.z);
    return result;
}

// a * b - fl(a * b) without error, barring overflow and underflow (Dekker 1971, Veltkamp split).
INLINE real product_error(real a, real b) {
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

// a * b - c * d with the exact sign, barring overflow and underflow. Rounding is monotone, so only
// a difference of exactly 0 can have lost its sign, and then the products' errors hold it.
INLINE real edge_function(real a, real b, real c, real d) {
    precise real difference = a * b - c * d;
    if (difference == real(0)) {
        precise real rest = product_error(a, b) - product_error(c, d);
        difference = rest;
    }
    return difference;
}

// The smaller (larger); a NaN candidate (0 * infinity, a ray in a box's plane) changes nothing.
INLINE real least(real kept, real candidate) { return candidate < kept ? candidate : kept; }
INLINE real greatest(real kept, real candidate) { return candidate > kept ? candidate : kept; }

// The two shorter edges of a triangle, whose roundings turn its plane least, and which corner lies
// between them: 0, 1 or 2. cross(e, f) points to the counter-clockwise side.
INLINE int short_edges(vec3 a, vec3 b, vec3 c, OUT(vec3) e, OUT(vec3) f) {
    precise vec3 ab = b - a;
    precise vec3 bc = c - b;
    precise vec3 ca = a - c;
    real ab_size = largest(abs(ab));
    real bc_size = largest(abs(bc));
    real ca_size = largest(abs(ca));
    bool ab_longest = ab_size >= bc_size && ab_size >= ca_size;
    bool bc_longest = !ab_longest && bc_size >= ca_size;
    e = ab_longest ? bc : (bc_longest ? ca : ab);
    f = ab_longest ? ca : (bc_longest ? ab : bc);
    return ab_longest ? 2 : (bc_longest ? 0 : 1);
}

// Watertight triangle test, both sides. True when the ray meets the triangle at a finite t > 0;
// weights / (their sum) are the barycentric weights of a, b, c (see `barycentric`).
INLINE bool triangle_test(vec3 a, vec3 b, vec3 c, vec3 origin, RayShear ray, OUT(real) t,
                          OUT(vec3) weights) {
    precise vec3 ta = turned(a - origin, ray.axis);
    precise vec3 tb = turned(b - origin, ray.axis);
    precise vec3 tc = turned(c - origin, ray.axis);
    precise real ax = ta.x - ray.shear.x * ta.z;
    precise real ay = ta.y - ray.shear.y * ta.z;
    precise real bx = tb.x - ray.shear.x * tb.z;
    precise real by = tb.y - ray.shear.y * tb.z;
    precise real cx = tc.x - ray.shear.x * tc.z;
    precise real cy = tc.y - ray.shear.y * tc.z;
    precise real u = edge_function(cx, by, cy, bx);
    precise real v = edge_function(ax, cy, ay, cx);
    precise real w = edge_function(bx, ay, by, ax);
    t = real(0);
    weights = vec3(u, v, w);
    bool inside = (u >= real(0) && v >= real(0) && w >= real(0)) ||
                  (u <= real(0) && v <= real(0) && w <= real(0));
    precise real det = u + v + w;
    if (!inside || det == real(0)) return false;
    // Where the ray meets the plane: the weights of a triangle a thousand times longer than high
    // would put that a thousand times further off.
    vec3 e, f;
    int between = short_edges(a, b, c, e, f);
    vec3 corner = between == 0 ? ta : (between == 1 ? tb : tc);
    precise vec3 normal = turned(vec3(e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z,
                                      e.x * f.y - e.y * f.x), ray.axis);
    precise real height = normal.x * corner.x + normal.y * corner.y + normal.z * corner.z;
    precise real slope = normal.x * ray.shear.x + normal.y * ray.shear.y + normal.z;
    // A plane seen edge-on within roundings is met anywhere: there the weights know better.
    real doubt = gamma_bound(64) * (abs(normal.x * ray.shear.x) + abs(normal.y * ray.shear.y) + abs(normal.z));
    precise vec3 at = ray.shear.z * vec3(ta.z, tb.z, tc.z);
    precise real at_weights = (u * at.x + v * at.y + w * at.z) / det;
    precise real at_plane = abs(slope) > doubt ? ray.shear.z * (height / slope) : at_weights;
    // Never before the first corner or behind the last; without a normal it is NaN or infinite.
    real first = min(at.x, min(at.y, at.z));
    t = least(largest(at), greatest(first, at_plane));
    return t > real(0) && t <= kLargest;
}

INLINE vec3 barycentric(vec3 weights) {
    precise real det = weights.x + weights.y + weights.z;
    return weights / det;
}

// What the box test needs of a ray. The triangle test sees a sheared ray that is off by roundings
// relative to its distance from the vertices; origins moved by that much keep every box that holds
// a triangle the test would accept (Woop et al. 2013, section 4).
struct BoxRay {
    vec3 near_origin; // for the planes where the ray enters
    vec3 far_origin;  // for the planes where it leaves
    vec3 inverse;     // 1 / direction, infinite where that is 0
};

// `lo`, `hi`: bounds of what the ray may meet; boxes of anything outside are wider by themselves (engine/bvh/bvh.cpp).
// `times`: how much wider boxes are for things in spaces of their own below them (engine/bvh/two_level.hpp); else 1.
INLINE BoxRay box_ray(Ray ray, vec3 lo, vec3 hi, real times) {
    real reach = largest(max(abs(lo - ray.origin), abs(hi - ray.origin)));
    real slack = gamma_bound(16) * reach * times;
    BoxRay result;
    result.inverse = vec3(real(1)) / ray.direction;
    vec3 step = vec3(result.inverse.x < real(0) ? -slack : slack,
                     result.inverse.y < real(0) ? -slack : slack,
                     result.inverse.z < real(0) ? -slack : slack);
    result.near_origin = ray.origin + step;
    result.far_origin = ray.origin - step;
    return result;
}

// Does the ray meet the box in [0, t_max]; enters at t_near.
INLINE bool slab_test(vec3 lo, vec3 hi, BoxRay ray, real t_max, OUT(real) t_near) {
    bool back_x = ray.inverse.x < real(0);
    bool back_y = ray.inverse.y < real(0);
    bool back_z = ray.inverse.z < real(0);
    vec3 enter = vec3(back_x ? hi.x : lo.x, back_y ? hi.y : lo.y, back_z ? hi.z : lo.z);
    vec3 leave = vec3(back_x ? lo.x : hi.x, back_y ? lo.y : hi.y, back_z ? lo.z : hi.z);
    vec3 t_enter = (enter - ray.near_origin) * ray.inverse;
    vec3 t_leave = (leave - ray.far_origin) * ray.inverse;
    t_near = greatest(greatest(greatest(real(0), t_enter.x), t_enter.y), t_enter.z);
    real t_far = least(least(least(t_max, t_leave.x), t_leave.y), t_leave.z);
    return t_near <= t_far * (real(1) + real(2) * gamma_bound(3));
}

// Nearest t in (0, t_max) where the ray meets the sphere, from outside or inside
// (Haines, Gunther, Akenine-Moller 2019: no difference of nearly equal squares).
INLINE bool sphere_test(vec3 centre, real radius, Ray ray, real t_max, OUT(real) t) {
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

// ---- Ray spawn: no world epsilon, only bounds of the roundings made ----------------------------

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

// ---- Things in spaces of their own --------------------------------------------------------------

// A place in the scene is the centre plus its arm, and the arm is `scene_...` times the place in the thing's own
// space. What is small beside its distance from the scene's origin has its digits there; the centre is a sum of
// two floats, and so is the origin of a ray that passes near.
struct Place {
    vec3 own_x, own_y, own_z;       // rows of the matrix from the scene's axes to its own
    vec3 scene_x, scene_y, scene_z; // columns of the matrix back
    vec3 centre, centre_low;
};

INLINE vec3 to_own(Place place, vec3 arm) {
    return vec3(dot(place.own_x, arm), dot(place.own_y, arm), dot(place.own_z, arm));
}
INLINE vec3 arm_of(Place place, vec3 own) {
    return own.x * place.scene_x + own.y * place.scene_y + own.z * place.scene_z;
}
// The unit normal that an own one becomes (by the inverse transpose); zero where there is none.
INLINE vec3 scene_normal(Place place, vec3 own) {
    vec3 n = own.x * place.own_x + own.y * place.own_y + own.z * place.own_z;
    real size = largest(abs(n));
    return size > real(0) ? normalize(n / size) : vec3(real(0));
}

// The ray as the thing sees it, with the same t; `low`: what its origin lacks.
INLINE Ray own_ray(Place place, Ray ray, vec3 low) {
    precise vec3 high = ray.origin - place.centre;
    precise vec3 rest = low - place.centre_low;
    precise vec3 arm = high + rest;
    Ray result;
    result.origin = to_own(place, arm);
    result.direction = to_own(place, ray.direction);
    result.leaves = ray.leaves;
    return result;
}

// How far arm_of(own) may be off for a ray that starts there and comes back into the thing's own space, if `own` is
// off by `error`: each way's roundings, and those of the centre's two floats.
INLINE vec3 arm_error(Place place, vec3 own, vec3 error) {
    vec3 x = abs(place.scene_x);
    vec3 y = abs(place.scene_y);
    vec3 z = abs(place.scene_z);
    vec3 size = abs(own.x) * x + abs(own.y) * y + abs(own.z) * z;
    vec3 back = dot(abs(place.own_x), size) * x + dot(abs(place.own_y), size) * y + dot(abs(place.own_z), size) * z;
    vec3 moved = error.x * x + error.y * y + error.z * z;
    return moved * (real(1) + gamma_bound(8)) + gamma_bound(16) * (size + back) +
           real(16) * kUnitRoundoff * kUnitRoundoff * abs(place.centre);
}

// The centre plus an arm, as a sum of two floats (Knuth's two-sum).
INLINE vec3 scene_point(Place place, vec3 arm, OUT(vec3) low) {
    precise vec3 sum = place.centre + arm;
    precise vec3 added = sum - place.centre;
    precise vec3 lost = (place.centre - (sum - added)) + (arm - added);
    precise vec3 rest = lost + place.centre_low;
    low = rest;
    return sum;
}

// ---- Captures ----------------------------------------------------------------------------------

// Direction from the capture's centre to the point that a ray from `offset` (relative to that
// centre) along unit `dir` would meet, if what it meets is `distance` from the centre. One step of
// the secant iteration. Nothing met, or met at the centre itself: `dir` as it is.
INLINE vec3 parallax_direction(vec3 offset, vec3 dir, real distance) {
    if (is_miss(distance)) return dir;
    vec3 p = offset + dir * (distance - dot(offset, dir));
    real size = largest(abs(p));
    if (!is_finite(size) || size <= real(0)) return dir;
    return normalize(p / size);
}

// Face of a cube map (+X, -X, +Y, -Y, +Z, -Z) that a direction meets; equals go to z, then y.
INLINE int cube_face(vec3 dir) {
    vec3 size = abs(dir);
    if (size.z >= size.x && size.z >= size.y) return dir.z < real(0) ? 5 : 4;
    if (size.y >= size.x) return dir.y < real(0) ? 3 : 2;
    return dir.x < real(0) ? 1 : 0;
}

// (sc, tc, ma) of the direction on the face: sc right, tc down, ma > 0 towards the face.
INLINE vec3 cube_coordinates(int face, vec3 dir) {
    if (face == 0) return vec3(-dir.z, -dir.y, dir.x);
    if (face == 1) return vec3(dir.z, -dir.y, -dir.x);
    if (face == 2) return vec3(dir.x, dir.z, dir.y);
    if (face == 3) return vec3(dir.x, -dir.z, -dir.y);
    if (face == 4) return vec3(dir.x, -dir.y, dir.z);
    return vec3(-dir.x, -dir.y, -dir.z);
}

// The direction whose coordinates on the face are (sc, tc, ma); inverse of cube_coordinates.
INLINE vec3 cube_direction(int face, vec3 coordinates) {
    real s = coordinates.x;
    real t = coordinates.y;
    real m = coordinates.z;
    if (face == 0) return vec3(m, -t, -s);
    if (face == 1) return vec3(-m, -t, s);
    if (face == 2) return vec3(s, m, t);
    if (face == 3) return vec3(s, -m, -t);
    if (face == 4) return vec3(s, -t, m);
    return vec3(-s, -t, -m);
}

// ---- Picture -----------------------------------------------------------------------------------

// The sRGB curve (IEC 61966-2-1) of linear light, both in [0, 1]; NaN is black.
INLINE real srgb_encoded(real linear) {
    if (!(linear > real(0))) return real(0);
    if (linear >= real(1)) return real(1);
    if (linear <= real(0.0031308)) return real(12.92) * linear;
    return real(1.055) * pow(linear, real(1) / real(2.4)) - real(0.055);
}

// ---- Layout of the bounding volume hierarchy (engine/bvh/bvh.hpp says what it means) -----------

const int kBvhMaxDepth = 30;        // inner nodes on a path, hence entries on a stack
const uint kBvhTag = 0x40000000u;   // set in every word: as a float it is neither denormal nor NaN
const uint kBvhCountShift = 27u;    // a child's triangle count; 0 for an inner node
const uint kBvhIndexMask = 0x07ffffffu;
const uint kBvhRoot = 0x40000001u;  // the child word of the root, node 1
const uint kBvhNothing = 0x40000000u;
const uint kBvhIdMask = 0x1fffffffu; // of a triangle's words
const uint kBvhHidden = 1u;          // flag: camera rays pass through
const uint kBvhShadowless = 2u;      // flag: shadow rays pass through (a light's own mesh)
const uint kBvhSphere = 4u;          // flag: stands for an exact sphere
const uint kBvhOneSided = 8u;        // flag: rays that see pass through from behind

// Whether a ray comes from behind a triangle: corners run clockwise for it.
INLINE bool is_from_behind(vec3 a, vec3 b, vec3 c, vec3 direction) {
    return dot(cross(b - a, c - a), direction) > real(0);
}

const uint kBvhEnters = 5u;          // in place of a triangle count: a thing in its own space, recorded at that node
const uint kBvhReturns = 0x70000000u; // on the stack: the way back from there
const uint kBvhRecordNodes = 3u;     // that such a record takes
const int kBvhMaxStack = 62;         // two trees' paths, the node above the first and the way back

INLINE uint bvh_count(uint word) { return (word & ~kBvhTag) >> kBvhCountShift; }
INLINE uint bvh_index(uint word) { return word & kBvhIndexMask; }
INLINE bool bvh_is_inner(uint word) { return bvh_count(word) == 0u && bvh_index(word) != 0u; }

#endif
