#pragma once

#include "bvh/box.hpp"

/// Boxes as the builder works on them: all axes at once.
namespace catoptric::bvh {

/// Of a box's corner x, y, z; what the fourth says is its owner's.
using Lanes = float __attribute__((vector_size(16)));

inline Lanes lanes(const vec3& v, float fourth) { return Lanes{v.x, v.y, v.z, fourth}; }
inline Lanes all_lanes(float v) { return Lanes{v, v, v, v}; }
inline vec3 vector(Lanes v) { return {v[0], v[1], v[2]}; }
/// The first where they are equal or one is no number.
inline Lanes smaller(Lanes a, Lanes b) { return b < a ? b : a; }
inline Lanes larger(Lanes a, Lanes b) { return b > a ? b : a; }

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A box; starts empty. Its fourth lanes say nothing.
struct Extent {
    Lanes lo = all_lanes(kInfinity);
    Lanes hi = all_lanes(-kInfinity);

    void add(Lanes point) { lo = smaller(lo, point), hi = larger(hi, point); }
    /// Where `away` is 0; nothing where it is infinite.
    void add_moved(Lanes point, Lanes away) {
        lo = smaller(lo, point + away), hi = larger(hi, point - away);
    }
    void add(const Extent& other) { lo = smaller(lo, other.lo), hi = larger(hi, other.hi); }
    Box box() const { return {vector(lo), vector(hi)}; }
    /// Half its surface; not of an empty one. In double: products of finite floats are finite.
    double half_area() const {
        const Lanes size = hi - lo;
        const double x = double{size[0]}, y = double{size[1]}, z = double{size[2]};
        return x * (y + z) + y * z;
    }
    /// Whether it is one point.
    bool is_point() const { return lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]; }
};

} // namespace catoptric::bvh
