// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Transforms between object space and scene units.

// The placement of an instance. A position in scene units is the centre plus an arm. The arm is the matrix of the
// columns `scene_...` times the position in object space. Object space keeps the digits of an object that is small
// compared with its distance from the scene's origin. The centre is a sum of two floats, as are origins of rays.
struct ObjectPlacement {
    vec3 own_x, own_y, own_z;       // rows of the matrix from the scene's axes to object space
    vec3 scene_x, scene_y, scene_z; // columns of the matrix from object space to the scene's axes
    vec3 centre, centre_low;        // origin of the object space and its rounding error, scene units
};

INLINE vec3 transform_offset_to_object_space(ObjectPlacement place, vec3 arm) {
    return vec3(dot(place.own_x, arm), dot(place.own_y, arm), dot(place.own_z, arm));
}
INLINE vec3 rotate_to_scene_offset(ObjectPlacement place, vec3 own) {
    return own.x * place.scene_x + own.y * place.scene_y + own.z * place.scene_z;
}
// Transforms a normal from object space to the scene by the inverse transpose. Returns a unit vector, or zero if the
// normal is zero.
INLINE vec3 transform_normal_out_of_object_space(ObjectPlacement place, vec3 own) {
    vec3 n = own.x * place.own_x + own.y * place.own_y + own.z * place.own_z;
    real size = largest_vector_component(abs(n));
    return size > real(0) ? normalize(n / size) : vec3(real(0));
}

// Returns (a + a_low) - (b + b_low) with about one rounding. Knuth's two-sum splits a - b into a float and its error.
INLINE vec3 subtract_split_vectors(vec3 a, vec3 a_low, vec3 b, vec3 b_low) {
    precise vec3 high = a - b;
    precise vec3 taken = a - high;
    precise vec3 lost = (a - (high + taken)) + (taken - b);
    precise vec3 rest = lost + (a_low - b_low);
    precise vec3 result = high + rest;
    return result;
}

// Transforms a ray to an instance's object space, where its points have the same t. `low` is the rounding error of the
// ray's origin.
INLINE Ray transform_ray_to_object_space(ObjectPlacement place, Ray ray, vec3 low) {
    precise vec3 high = ray.origin - place.centre;
    precise vec3 rest = low - place.centre_low;
    precise vec3 arm = high + rest;
    Ray result;
    result.origin = transform_offset_to_object_space(place, arm);
    result.direction = transform_offset_to_object_space(place, ray.direction);
    result.leaves = ray.leaves;
    return result;
}

// Returns a bound of the error of rotate_to_scene_offset(own), where `own` has the error `error`. The bound covers the
// roundings of the transform to the scene, of a ray's transform back, and of the centre's two floats.
INLINE vec3 offset_rounding_error(ObjectPlacement place, vec3 own, vec3 error) {
    vec3 x = abs(place.scene_x);
    vec3 y = abs(place.scene_y);
    vec3 z = abs(place.scene_z);
    vec3 size = abs(own.x) * x + abs(own.y) * y + abs(own.z) * z;
    vec3 back = dot(abs(place.own_x), size) * x + dot(abs(place.own_y), size) * y + dot(abs(place.own_z), size) * z;
    vec3 moved = error.x * x + error.y * y + error.z * z;
    return moved * (real(1) + rounding_error_gamma_bound(8)) + rounding_error_gamma_bound(16) * (size + back) +
           real(16) * kUnitRoundoff * kUnitRoundoff * abs(place.centre);
}

// Returns the centre plus an arm as the sum of two floats, the result and `low` (Knuth's two-sum).
INLINE vec3 add_offset_to_object_centre(ObjectPlacement place, vec3 arm, OUT(vec3) low) {
    precise vec3 sum = place.centre + arm;
    precise vec3 added = sum - place.centre;
    precise vec3 lost = (place.centre - (sum - added)) + (arm - added);
    precise vec3 rest = lost + place.centre_low;
    low = rest;
    return sum;
}
