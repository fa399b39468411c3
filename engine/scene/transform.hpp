#pragma once

#include "core/math.hpp"

#include <cmath>

namespace catoptric::scene {

inline dvec3 transform_point(const dmat4& world_from_object, const dvec3& point) {
    return dvec3(world_from_object * dvec4(point, 1));
}

/// What normals are multiplied with: the inverse transpose times |determinant|, so it exists for a
/// singular matrix too. The result is not normalised.
inline dmat3 normal_matrix(const dmat4& world_from_object) {
    const dmat3 m(world_from_object);
    const dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], cofactors[0]) < 0 ? -cofactors : cofactors;
}

/// Unit vector along `v`, or zero where `v` has no direction (zero or not finite).
inline dvec3 normalized_or_zero(const dvec3& v) {
    const double length = std::hypot(v.x, v.y, v.z);
    return length > 0 && std::isfinite(length) ? v / length : dvec3(0);
}

} // namespace catoptric::scene
