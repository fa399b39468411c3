#pragma once

#include "bvh/box.hpp"

/// Boxes as vectors, so that the builder processes all axes at once.
namespace catoptric::bvh {

/// The x, y and z of a box corner. The owner of the box defines the fourth element.
using Lanes = float __attribute__((vector_size(16)));

inline Lanes lanes(const vec3& v, float fourth) { return Lanes{v.x, v.y, v.z, fourth}; }
inline Lanes all_lanes(float v) { return Lanes{v, v, v, v}; }
inline vec3 vector(Lanes v) { return {v[0], v[1], v[2]}; }
/// Returns the element-wise minimum and maximum; `a` if both are equal or one is NaN.
inline Lanes smaller(Lanes a, Lanes b) { return b < a ? b : a; }
inline Lanes larger(Lanes a, Lanes b) { return b > a ? b : a; }

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A box, empty at first. The fourth elements have no meaning.
struct Extent {
    Lanes lo = all_lanes(kInfinity);
    Lanes hi = all_lanes(-kInfinity);

    void add(Lanes point) { lo = smaller(lo, point), hi = larger(hi, point); }
    /// Adds the point if `away` is 0; does nothing if `away` is infinite.
    void add_moved(Lanes point, Lanes away) {
        lo = smaller(lo, point + away), hi = larger(hi, point - away);
    }
    void add(const Extent& other) { lo = smaller(lo, other.lo), hi = larger(hi, other.hi); }
    BoundingBox box() const { return {vector(lo), vector(hi)}; }
    /// Returns half the surface area. The box must not be empty. Computes in double, where products
    /// of finite floats cannot overflow.
    double half_area() const {
        const Lanes size = hi - lo;
        const double x = double{size[0]}, y = double{size[1]}, z = double{size[2]};
        return x * (y + z) + y * z;
    }
    /// Returns whether the box is a single point.
    bool is_point() const { return lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]; }
};

} // namespace catoptric::bvh
