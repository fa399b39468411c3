// Part of lib/math.glsl, which alone includes it.
// Things in spaces of their own.

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

// (a + a_low) - (b + b_low), rounded about once: a - b is split into a float and its error (Knuth's two-sum).
INLINE vec3 difference_of_sums(vec3 a, vec3 a_low, vec3 b, vec3 b_low) {
    precise vec3 high = a - b;
    precise vec3 taken = a - high;
    precise vec3 lost = (a - (high + taken)) + (taken - b);
    precise vec3 rest = lost + (a_low - b_low);
    precise vec3 result = high + rest;
    return result;
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
