#pragma once

#include "bvh/bvh.hpp"

/// Boxes of a hierarchy, as those who build and refit it make them.
namespace catoptric::bvh {

using Box = Bounds<float>;

inline constexpr double kTraversalCost = 2; // of a node, in triangle tests

/// In double, where the extent of finite floats cannot overflow.
inline double area(const Box& box) { return Bounds<double>{dvec3(box.lo), dvec3(box.hi)}.area(); }

/// What the walk's slack lacks for a triangle that reaches out of the core: its distance from the
/// middle, of which box_ray (shaders/lib/math/ray.glsl) takes the same part for rays that start in
/// the core.
inline float pad_of(const Box& box, const Box& core) {
    const bool inside = all(lessThanEqual(core.lo, box.lo)) && all(lessThanEqual(box.hi, core.hi));
    if (inside) return 0;
    const vec3 middle = core.lo * 0.5f + core.hi * 0.5f;
    return 2 * f32::gamma_bound(16) *
           f32::largest(max(abs(box.lo - middle), abs(box.hi - middle))); // twice: roundings here
}

/// Wider all around, as far as finite numbers go.
inline Box padded(const Box& box, float pad) {
    return {max(box.lo - pad, vec3(-f32::kLargest)), min(box.hi + pad, vec3(f32::kLargest))};
}

/// Of a triangle, or of a ball with what its test's roundings reach out of it.
inline Box box_of(const vec3& a, const vec3& b, const vec3& c, std::uint32_t flags) {
    Box box;
    if ((flags & kBall) != 0) {
        const float reach = b.x + f32::gamma_bound(16) * (b.x + f32::largest(abs(a)));
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
