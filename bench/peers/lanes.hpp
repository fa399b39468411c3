#pragma once

#include "whitted.hpp"

#include <cmath>
#include <cstring>

/// SIMD vectors with one lane for each ray. The same source code traces single rays and packets.
namespace peers {

/// The types and Embree calls for single rays. `Eight` and `Sixteen` are the same for packets of 8
/// and 16 rays. A mask has all bits set, or 0, in each lane.
struct One {
    using Real = float;
    using Mask = int;
    using Hits = RTCRayHit;
    using Rays = RTCRay;
    static constexpr int kCount = 1, kWidth = 1;
    static void meet(const Mask&, RTCScene tree, RTCIntersectContext* context, Hits& hits) {
        rtcIntersect1(tree, context, &hits);
    }
    static void block(const Mask&, RTCScene tree, RTCIntersectContext* context, Rays& rays) {
        rtcOccluded1(tree, context, &rays);
    }
};
struct Eight {
    using Real = float __attribute__((vector_size(32)));
    using Mask = int __attribute__((vector_size(32)));
    using Hits = RTCRayHit8;
    using Rays = RTCRay8;
    static constexpr int kCount = 8, kWidth = 4;
    static void meet(const Mask& valid, RTCScene tree, RTCIntersectContext* context, Hits& hits) {
        rtcIntersect8(reinterpret_cast<const int*>(&valid), tree, context, &hits);
    }
    static void block(const Mask& valid, RTCScene tree, RTCIntersectContext* context, Rays& rays) {
        rtcOccluded8(reinterpret_cast<const int*>(&valid), tree, context, &rays);
    }
};
struct Sixteen {
    using Real = float __attribute__((vector_size(64)));
    using Mask = int __attribute__((vector_size(64)));
    using Hits = RTCRayHit16;
    using Rays = RTCRay16;
    static constexpr int kCount = 16, kWidth = 4;
    static void meet(const Mask& valid, RTCScene tree, RTCIntersectContext* context, Hits& hits) {
        rtcIntersect16(reinterpret_cast<const int*>(&valid), tree, context, &hits);
    }
    static void block(const Mask& valid, RTCScene tree, RTCIntersectContext* context, Rays& rays) {
        rtcOccluded16(reinterpret_cast<const int*>(&valid), tree, context, &rays);
    }
};

inline int greater(float a, float b) { return a > b ? -1 : 0; }
template <typename Real>
auto greater(Real a, Real b) -> decltype(a > b) {
    return a > b;
}
inline float select(int mask, float a, float b) { return mask ? a : b; }
template <typename Mask, typename Real>
Real select(Mask mask, Real a, Real b) {
    return mask ? a : b;
}
inline float lane(float value, int) { return value; }
inline int lane(int value, int) { return value; }
template <typename Value>
auto lane(const Value& value, int i) {
    return value[i];
}
inline void put(float& to, int, float value) { to = value; }
inline void put(int& to, int, int value) { to = value; }
template <typename Value, typename Part>
void put(Value& to, int i, Part value) {
    to[i] = value;
}
inline float root(float value) { return std::sqrt(value); }
template <typename Real>
Real root(Real value) {
    for (std::size_t i = 0; i < sizeof value / sizeof value[0]; ++i) value[i] = std::sqrt(value[i]);
    return value;
}
/// Stores a vector into an array, or a number, of Embree's structures. `load` is the inverse.
template <typename Field, typename Value>
void store(Field& field, const Value& value) {
    static_assert(sizeof field == sizeof value);
    std::memcpy(&field, &value, sizeof value);
}
template <typename Value, typename Field>
Value load(const Field& field) {
    Value value;
    static_assert(sizeof field == sizeof value);
    std::memcpy(&value, &field, sizeof value);
    return value;
}

template <typename Real>
struct Three {
    Real x, y, z;
    friend Three operator+(Three a, Three b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Three operator-(Three a, Three b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Three operator*(Three a, Three b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
    friend Three operator*(Real s, Three a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <typename Real>
Real dot(Three<Real> a, Three<Real> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename Real>
Three<Real> normalize(Three<Real> a) {
    const Real length = root(dot(a, a));
    return {a.x / length, a.y / length, a.z / length};
}
template <typename Mask, typename Real>
Three<Real> select(Mask mask, Three<Real> a, Three<Real> b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
template <typename Real>
Three<Real> same(Vector v) {
    return {Real{} + v.x, Real{} + v.y, Real{} + v.z};
}
template <typename Real>
void put(Three<Real>& to, int i, Vector v) {
    put(to.x, i, v.x), put(to.y, i, v.y), put(to.z, i, v.z);
}
template <typename Real>
Three<float> lane(const Three<Real>& a, int i) {
    return {lane(a.x, i), lane(a.y, i), lane(a.z, i)};
}
inline Vector plain(Three<float> a) { return {a.x, a.y, a.z}; }

} // namespace peers
