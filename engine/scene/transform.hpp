#pragma once

#include "core/math.hpp"

#include <cmath>

namespace catoptric::scene {

inline dvec3 transform_point(const dmat4& world_from_object, const dvec3& point) {
    return dvec3(world_from_object * dvec4(point, 1));
}

template <typename Vector>
bool is_finite(const Vector& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns the matrix that transforms normals: the inverse transpose times |determinant|. It exists
/// for a singular matrix, too. Transformed normals are not normalised.
inline dmat3 normal_matrix(const dmat4& world_from_object) {
    const dmat3 m(world_from_object);
    const dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], cofactors[0]) < 0 ? -cofactors : cofactors;
}

/// Returns the unit vector along `v`, or zero if `v` has no direction (zero or not finite).
inline dvec3 normalized_or_zero(const dvec3& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    return length > 0 && std::isfinite(length) ? v / length : dvec3(0);
}

/// Returns the unit normal in the world. If a singular matrix maps `normal` to zero, returns the
/// normal of the plane that contains the transformed object. If there is no such plane, returns +z.
inline dvec3 transform_normal(const dmat3& normal_to_world, const dvec3& normal) {
    const dvec3 turned = normalized_or_zero(normal_to_world * normal);
    if (turned != dvec3(0)) return turned;
    for (int i = 0; i < 3; ++i)
        if (const dvec3 of_plane = normalized_or_zero(normal_to_world[i]); of_plane != dvec3(0))
            return of_plane;
    return {0, 0, 1};
}

} // namespace catoptric::scene
