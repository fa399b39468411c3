#pragma once

#include "bvh/box.hpp"

/// Boxes as vectors, so that the builder processes all axes at once.
namespace catoptric::bvh {

/// The x, y and z of a box corner. The owner of the box defines the fourth element.
using SimdFloat4 = float __attribute__((vector_size(16)));

inline SimdFloat4 load_simd(const vec3& v, float fourth) {
    return SimdFloat4{v.x, v.y, v.z, fourth};
}
inline SimdFloat4 broadcast_simd(float v) { return SimdFloat4{v, v, v, v}; }
inline vec3 to_vec3(SimdFloat4 v) { return {v[0], v[1], v[2]}; }
/// Returns the element-wise minimum and maximum; `a` if both are equal or one is NaN.
inline SimdFloat4 simd_min(SimdFloat4 a, SimdFloat4 b) { return b < a ? b : a; }
inline SimdFloat4 simd_max(SimdFloat4 a, SimdFloat4 b) { return b > a ? b : a; }

inline constexpr float kInfinityFloat = std::numeric_limits<float>::infinity();

/// A box, empty at first. The fourth elements have no meaning.
struct SimdBox {
    SimdFloat4 lo = broadcast_simd(kInfinityFloat);
    SimdFloat4 hi = broadcast_simd(-kInfinityFloat);

    void add_point(SimdFloat4 point) { lo = simd_min(lo, point), hi = simd_max(hi, point); }
    /// Adds the point if `away` is 0; does nothing if `away` is infinite.
    void add_point_unless(SimdFloat4 point, SimdFloat4 away) {
        lo = simd_min(lo, point + away), hi = simd_max(hi, point - away);
    }
    void add_box(const SimdBox& other) { lo = simd_min(lo, other.lo), hi = simd_max(hi, other.hi); }
    BoundingBox to_bounds() const { return {to_vec3(lo), to_vec3(hi)}; }
    /// Returns half the surface area. The box must not be empty. Computes in double, where products
    /// of finite floats cannot overflow.
    double half_area() const {
        const SimdFloat4 size = hi - lo;
        const double x = double{size[0]}, y = double{size[1]}, z = double{size[2]};
        return x * (y + z) + y * z;
    }
    bool is_point() const { return lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]; }
};

} // namespace catoptric::bvh
