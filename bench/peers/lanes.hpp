#pragma once

#include "whitted.hpp"

#include <cmath>
#include <cstring>

/// SIMD vectors with one lane for each ray. The same source code traces single rays and packets.
namespace peers {

/// The types and Embree calls for single rays. `EightRayPacket` and `SixteenRayPacket` are the same
/// for packets of 8 and 16 rays. A mask has all bits set, or 0, in each lane.
struct OneRayPacket {
    using Real = float;
    using Mask = int;
    using Hits = RTCRayHit;
    using Rays = RTCRay;
    static constexpr int kRaysPerPacket = 1, kWidth = 1;
    static void find_closest_hits(const Mask&, RTCScene tree, RTCIntersectContext* context,
                                  Hits& hits) {
        rtcIntersect1(tree, context, &hits);
    }
    static void find_occluded_packet_lanes(const Mask&, RTCScene tree, RTCIntersectContext* context,
                                           Rays& rays) {
        rtcOccluded1(tree, context, &rays);
    }
};
struct EightRayPacket {
    using Real = float __attribute__((vector_size(32)));
    using Mask = int __attribute__((vector_size(32)));
    using Hits = RTCRayHit8;
    using Rays = RTCRay8;
    static constexpr int kRaysPerPacket = 8, kWidth = 4;
    static void find_closest_hits(const Mask& valid, RTCScene tree, RTCIntersectContext* context,
                                  Hits& hits) {
        rtcIntersect8(reinterpret_cast<const int*>(&valid), tree, context, &hits);
    }
    static void find_occluded_packet_lanes(const Mask& valid, RTCScene tree,
                                           RTCIntersectContext* context, Rays& rays) {
        rtcOccluded8(reinterpret_cast<const int*>(&valid), tree, context, &rays);
    }
};
struct SixteenRayPacket {
    using Real = float __attribute__((vector_size(64)));
    using Mask = int __attribute__((vector_size(64)));
    using Hits = RTCRayHit16;
    using Rays = RTCRay16;
    static constexpr int kRaysPerPacket = 16, kWidth = 4;
    static void find_closest_hits(const Mask& valid, RTCScene tree, RTCIntersectContext* context,
                                  Hits& hits) {
        rtcIntersect16(reinterpret_cast<const int*>(&valid), tree, context, &hits);
    }
    static void find_occluded_packet_lanes(const Mask& valid, RTCScene tree,
                                           RTCIntersectContext* context, Rays& rays) {
        rtcOccluded16(reinterpret_cast<const int*>(&valid), tree, context, &rays);
    }
};

inline int is_lane_greater(float a, float b) { return a > b ? -1 : 0; }
template <typename Real>
auto is_lane_greater(Real a, Real b) -> decltype(a > b) {
    return a > b;
}
inline float select_lanes(int mask, float a, float b) { return mask ? a : b; }
template <typename Mask, typename Real>
Real select_lanes(Mask mask, Real a, Real b) {
    return mask ? a : b;
}
inline float read_lane(float value, int) { return value; }
inline int read_lane(int value, int) { return value; }
template <typename Value>
auto read_lane(const Value& value, int i) {
    return value[i];
}
inline void write_lane(float& to, int, float value) { to = value; }
inline void write_lane(int& to, int, int value) { to = value; }
template <typename Value, typename Part>
void write_lane(Value& to, int i, Part value) {
    to[i] = value;
}
inline float square_root(float value) { return std::sqrt(value); }
template <typename Real>
Real square_root(Real value) {
    for (std::size_t i = 0; i < sizeof value / sizeof value[0]; ++i) value[i] = std::sqrt(value[i]);
    return value;
}
/// Stores a vector into an array, or a number, of Embree's structures. `load_packet_values` is the
/// inverse.
template <typename Field, typename Value>
void store_packet_values(Field& field, const Value& value) {
    static_assert(sizeof field == sizeof value);
    std::memcpy(&field, &value, sizeof value);
}
template <typename Value, typename Field>
Value load_packet_values(const Field& field) {
    Value value;
    static_assert(sizeof field == sizeof value);
    std::memcpy(&value, &field, sizeof value);
    return value;
}

template <typename Real>
struct PacketVector {
    Real x, y, z;
    friend PacketVector operator+(PacketVector a, PacketVector b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend PacketVector operator-(PacketVector a, PacketVector b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend PacketVector operator*(PacketVector a, PacketVector b) {
        return {a.x * b.x, a.y * b.y, a.z * b.z};
    }
    friend PacketVector operator*(Real s, PacketVector a) { return {s * a.x, s * a.y, s * a.z}; }
};
template <typename Real>
Real dot_product(PacketVector<Real> a, PacketVector<Real> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename Real>
PacketVector<Real> normalize_vector(PacketVector<Real> a) {
    const Real length = square_root(dot_product(a, a));
    return {a.x / length, a.y / length, a.z / length};
}
template <typename Mask, typename Real>
PacketVector<Real> select_lanes(Mask mask, PacketVector<Real> a, PacketVector<Real> b) {
    return {select_lanes(mask, a.x, b.x), select_lanes(mask, a.y, b.y),
            select_lanes(mask, a.z, b.z)};
}
template <typename Real>
PacketVector<Real> broadcast_vector(PeerVector3 v) {
    return {Real{} + v.x, Real{} + v.y, Real{} + v.z};
}
template <typename Real>
void write_lane(PacketVector<Real>& to, int i, PeerVector3 v) {
    write_lane(to.x, i, v.x), write_lane(to.y, i, v.y), write_lane(to.z, i, v.z);
}
template <typename Real>
PacketVector<float> read_lane(const PacketVector<Real>& a, int i) {
    return {read_lane(a.x, i), read_lane(a.y, i), read_lane(a.z, i)};
}
inline PeerVector3 packet_lane_to_vector(PacketVector<float> a) { return {a.x, a.y, a.z}; }

} // namespace peers
