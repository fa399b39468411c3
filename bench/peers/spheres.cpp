// Compiled with the options of whitted.cpp, for this machine's processor.
#include "spheres.hpp"

#include "lanes.hpp"

#include <limits>

namespace peers {

namespace {

const PeerSphere& sphere_at_index(const void* list, unsigned number) {
    return static_cast<const PeerSphere*>(list)[number];
}

void write_sphere_bounds(const RTCBoundsFunctionArguments* asked) {
    const auto& [centre, radius] = sphere_at_index(asked->geometryUserPtr, asked->primID);
    RTCBounds& box = *asked->bounds_o;
    box.lower_x = centre.x - radius, box.lower_y = centre.y - radius,
    box.lower_z = centre.z - radius;
    box.upper_x = centre.x + radius, box.upper_y = centre.y + radius,
    box.upper_z = centre.z + radius;
}

/// Intersects a packet of rays with a sphere. The discriminant is computed from the ray's point
/// nearest to the centre, which stays precise far away (Haines, Günther, Akenine-Möller 2019).
template <typename Kind>
struct SphereIntersection {
    using Real = typename Kind::Real;
    typename Kind::Mask met;
    Real t;
    PacketVector<Real> arm; ///< vector from the sphere's centre to the hit

    SphereIntersection(const PeerSphere& sphere, const typename Kind::Rays& ray,
                       const typename Kind::Mask& valid) {
        const PacketVector<Real> direction{load_packet_values<Real>(ray.dir_x),
                                           load_packet_values<Real>(ray.dir_y),
                                           load_packet_values<Real>(ray.dir_z)};
        const PacketVector<Real> from = PacketVector<Real>{load_packet_values<Real>(ray.org_x),
                                                           load_packet_values<Real>(ray.org_y),
                                                           load_packet_values<Real>(ray.org_z)} -
                                        broadcast_vector<Real>(sphere.centre);
        const Real scale = (Real{} + 1.0f) / dot_product(direction, direction);
        const Real nearest = Real{} - scale * dot_product(from, direction);
        const PacketVector<Real> off = from + nearest * direction;
        const Real rest = (Real{} + sphere.radius * sphere.radius) - dot_product(off, off);
        const Real half = square_root(scale *
                                      select_lanes(is_lane_greater(rest, Real{}), rest, Real{}));
        const Real begin = load_packet_values<Real>(ray.tnear),
                   end = load_packet_values<Real>(ray.tfar);
        const Real first = nearest - half, second = nearest + half;
        t = select_lanes(is_lane_greater(first, begin), first, second);
        met = valid & is_lane_greater(rest, Real{}) & is_lane_greater(t, begin) &
              is_lane_greater(end, t);
        arm = from + t * direction;
    }
};

/// Stores a vector into one of Embree's arrays, in the lanes of the mask only.
template <typename Mask, typename Value, typename Field>
void store_values_of_active_lanes(const Mask& mask, Field& field, const Value& value) {
    store_packet_values(field, select_lanes(mask, value, load_packet_values<Value>(field)));
}

template <typename Kind>
void intersect_sphere_with_any_ray_packet(const RTCIntersectFunctionNArguments* asked) {
    using Mask = typename Kind::Mask;
    auto& hits = *reinterpret_cast<typename Kind::Hits*>(asked->rayhit);
    Mask valid;
    std::memcpy(&valid, asked->valid, sizeof valid);
    const SphereIntersection<Kind> meeting(sphere_at_index(asked->geometryUserPtr, asked->primID),
                                           hits.ray, valid);
    store_values_of_active_lanes(meeting.met, hits.ray.tfar, meeting.t);
    store_values_of_active_lanes(meeting.met, hits.hit.Ng_x, meeting.arm.x);
    store_values_of_active_lanes(meeting.met, hits.hit.Ng_y, meeting.arm.y);
    store_values_of_active_lanes(meeting.met, hits.hit.Ng_z, meeting.arm.z);
    store_values_of_active_lanes(meeting.met, hits.hit.geomID,
                                 Mask{} + static_cast<int>(asked->geomID));
    store_values_of_active_lanes(meeting.met, hits.hit.primID,
                                 Mask{} + static_cast<int>(asked->primID));
}

template <typename Kind>
void test_any_packet_sphere_occlusion(const RTCOccludedFunctionNArguments* asked) {
    using Real = typename Kind::Real;
    auto& rays = *reinterpret_cast<typename Kind::Rays*>(asked->ray);
    typename Kind::Mask valid;
    std::memcpy(&valid, asked->valid, sizeof valid);
    const SphereIntersection<Kind> meeting(sphere_at_index(asked->geometryUserPtr, asked->primID),
                                           rays, valid);
    store_values_of_active_lanes(meeting.met, rays.tfar,
                                 Real{} - std::numeric_limits<float>::infinity());
}

void intersect_ray_packet_with_sphere(const RTCIntersectFunctionNArguments* asked) {
    if (asked->N == 1) return intersect_sphere_with_any_ray_packet<OneRayPacket>(asked);
    if (asked->N == 8) return intersect_sphere_with_any_ray_packet<EightRayPacket>(asked);
    intersect_sphere_with_any_ray_packet<SixteenRayPacket>(asked);
}
void test_packet_sphere_occlusion(const RTCOccludedFunctionNArguments* asked) {
    if (asked->N == 1) return test_any_packet_sphere_occlusion<OneRayPacket>(asked);
    if (asked->N == 8) return test_any_packet_sphere_occlusion<EightRayPacket>(asked);
    test_any_packet_sphere_occlusion<SixteenRayPacket>(asked);
}

} // namespace

RTCGeometry make_sphere_geometry(RTCDevice device, const std::vector<PeerSphere>& spheres) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
    rtcSetGeometryUserData(geometry, const_cast<PeerSphere*>(spheres.data()));
    rtcSetGeometryBoundsFunction(geometry, write_sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect_ray_packet_with_sphere);
    rtcSetGeometryOccludedFunction(geometry, test_packet_sphere_occlusion);
    rtcCommitGeometry(geometry);
    return geometry;
}

} // namespace peers
