#pragma once

#include "bvh/bvh.hpp"

/// Bounding boxes that the build and the refit of a hierarchy share.
namespace catoptric::bvh {

using BoundingBox = Bounds<float>;

inline constexpr double kNodeVisitCost = 2; // in triangle tests

/// Returns 0 for an empty box.
inline double surface_area(const Bounds<double>& box) {
    if (box.empty()) return 0;
    const dvec3 e = box.extent();
    return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
}
/// Computes in double, where the extents of finite floats cannot overflow.
inline double surface_area(const BoundingBox& box) {
    return surface_area(Bounds<double>{dvec3(box.lo), dvec3(box.hi)});
}

/// Returns by how much the box of a triangle outside the core must grow on each side. The ray
/// traversal widens every box by a slack that make_box_ray (shaders/lib/math/ray.glsl) derives from
/// the size of the core. That slack is too small for a triangle that reaches out of the core. This
/// pad adds the same fraction of the triangle's distance from the middle of the core. Returns 0 for
/// a box inside the core.
inline float box_padding(const BoundingBox& box, const BoundingBox& core) {
    const bool inside = all(lessThanEqual(core.lo, box.lo)) && all(lessThanEqual(box.hi, core.hi));
    if (inside) return 0;
    const vec3 middle = core.lo * 0.5f + core.hi * 0.5f;
    return 2 * f32::rounding_error_gamma_bound(16) *
           // The error bound is doubled, to cover the rounding errors of this function as well.
           f32::largest_vector_component(max(abs(box.lo - middle), abs(box.hi - middle)));
}

/// Returns the box, grown by `pad` on each side and clamped to the range of finite floats.
inline BoundingBox expand(const BoundingBox& box, float pad) {
    return {max(box.lo - pad, vec3(-f32::kLargestFloat)),
            min(box.hi + pad, vec3(f32::kLargestFloat))};
}

/// Returns the bounds of a triangle. If `flags` has kSpherePrimitiveFlag, returns the bounds of a
/// sphere, grown by the rounding errors of the sphere test.
inline BoundingBox triangle_bounds(const vec3& a, const vec3& b, const vec3& c,
                                   std::uint32_t flags) {
    BoundingBox box;
    if ((flags & kSpherePrimitiveFlag) != 0) {
        const float reach = b.x + f32::rounding_error_gamma_bound(16) *
                                      (b.x + f32::largest_vector_component(abs(a)));
        box.add(a - reach), box.add(a + reach);
    } else {
        box.add(a), box.add(b), box.add(c);
    }
    return box;
}

inline bool is_finite(const Triangle& t) {
    return f32::is_finite(t.a) && f32::is_finite(t.b) && f32::is_finite(t.c);
}

} // namespace catoptric::bvh
