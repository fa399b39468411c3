#pragma once

#include "bvh/box.hpp"

/// Boxes as vectors, so that the builder processes all axes at once.
namespace catoptric::bvh {

/// The x, y and z of a box corner. The owner of the box defines the fourth element.
using SimdLanes = float __attribute__((vector_size(16)));

inline SimdLanes load_lanes(const vec3& v, float fourth) {
    return SimdLanes{v.x, v.y, v.z, fourth};
}
inline SimdLanes broadcast_lanes(float v) { return SimdLanes{v, v, v, v}; }
inline vec3 lanes_to_vec3(SimdLanes v) { return {v[0], v[1], v[2]}; }
/// Returns the element-wise minimum and maximum; `a` if both are equal or one is NaN.
inline SimdLanes lanes_min(SimdLanes a, SimdLanes b) { return b < a ? b : a; }
inline SimdLanes lanes_max(SimdLanes a, SimdLanes b) { return b > a ? b : a; }

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A box, empty at first. The fourth elements have no meaning.
struct BoxExtent {
    SimdLanes lo = broadcast_lanes(kInfinity);
    SimdLanes hi = broadcast_lanes(-kInfinity);

    void add(SimdLanes point) { lo = lanes_min(lo, point), hi = lanes_max(hi, point); }
    /// Adds the point if `away` is 0; does nothing if `away` is infinite.
    void add_moved(SimdLanes point, SimdLanes away) {
        lo = lanes_min(lo, point + away), hi = lanes_max(hi, point - away);
    }
    void add(const BoxExtent& other) { lo = lanes_min(lo, other.lo), hi = lanes_max(hi, other.hi); }
    BoundingBox box() const { return {lanes_to_vec3(lo), lanes_to_vec3(hi)}; }
    /// Returns half the surface area. The box must not be empty. Computes in double, where products
    /// of finite floats cannot overflow.
    double half_area() const {
        const SimdLanes size = hi - lo;
        const double x = double{size[0]}, y = double{size[1]}, z = double{size[2]};
        return x * (y + z) + y * z;
    }
    /// Returns whether the box is a single point.
    bool is_point() const { return lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]; }
};

} // namespace catoptric::bvh
