// Part of lib/math.glsl; only lib/math.glsl includes this file.
// Mathematics of captures, cube maps around a centre.

// Returns whether a captured distance means that no surface was captured, which is stored as +infinity.
INLINE bool is_miss(real distance) { return isnan(distance) || distance > kLargestFloat; }

// Parallax correction, one step of the secant iteration. Returns the direction from the capture's centre to the point
// that a ray meets, if the point is `distance` away from the centre. The ray starts at `offset` from the
// centre, along the unit vector `dir`. Returns `dir` if no surface was captured or the point is the centre itself.
INLINE vec3 parallax_direction(vec3 offset, vec3 dir, real distance) {
    if (is_miss(distance)) return dir;
    vec3 p = offset + dir * (distance - dot(offset, dir));
    real size = largest_vector_component(abs(p));
    if (!is_finite(size) || size <= real(0)) return dir;
    return normalize(p / size);
}

// Returns the face of a cube map (+X, -X, +Y, -Y, +Z, -Z) that a direction meets. If components are equal in size, z
// wins over y, and y over x.
INLINE int cube_face(vec3 dir) {
    vec3 size = abs(dir);
    if (size.z >= size.x && size.z >= size.y) return dir.z < real(0) ? 5 : 4;
    if (size.y >= size.x) return dir.y < real(0) ? 3 : 2;
    return dir.x < real(0) ? 1 : 0;
}

// Returns a direction's coordinates (sc, tc, ma) on a cube face: sc to the right, tc down, ma > 0 towards the face.
INLINE vec3 cube_coordinates(int face, vec3 dir) {
    if (face == 0) return vec3(-dir.z, -dir.y, dir.x);
    if (face == 1) return vec3(dir.z, -dir.y, -dir.x);
    if (face == 2) return vec3(dir.x, dir.z, dir.y);
    if (face == 3) return vec3(dir.x, -dir.z, -dir.y);
    if (face == 4) return vec3(dir.x, -dir.y, dir.z);
    return vec3(-dir.x, -dir.y, -dir.z);
}

// Returns the direction whose coordinates on the face are (sc, tc, ma). This is the inverse of cube_coordinates.
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
