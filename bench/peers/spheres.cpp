// Compiled with the options of whitted.cpp, for this machine's processor.
#include "spheres.hpp"

#include "lanes.hpp"

#include <limits>

namespace peers {

namespace {

const Sphere& sphere_at(const void* list, unsigned number) {
    return static_cast<const Sphere*>(list)[number];
}

void put_bounds(const RTCBoundsFunctionArguments* asked) {
    const auto& [centre, radius] = sphere_at(asked->geometryUserPtr, asked->primID);
    RTCBounds& box = *asked->bounds_o;
    box.lower_x = centre.x - radius, box.lower_y = centre.y - radius,
    box.lower_z = centre.z - radius;
    box.upper_x = centre.x + radius, box.upper_y = centre.y + radius,
    box.upper_z = centre.z + radius;
}

/// Intersects a packet of rays with a sphere. The discriminant is computed from the ray's point
/// nearest to the centre, which stays precise far away (Haines, Günther, Akenine-Möller 2019).
template <typename Kind>
struct Meeting {
    using Real = typename Kind::Real;
    typename Kind::Mask met;
    Real t;
    Three<Real> arm; ///< vector from the sphere's centre to the hit

    Meeting(const Sphere& sphere, const typename Kind::Rays& ray,
            const typename Kind::Mask& valid) {
        const Three<Real> direction{load<Real>(ray.dir_x), load<Real>(ray.dir_y),
                                    load<Real>(ray.dir_z)};
        const Three<Real> from = Three<Real>{load<Real>(ray.org_x), load<Real>(ray.org_y),
                                             load<Real>(ray.org_z)} -
                                 same<Real>(sphere.centre);
        const Real scale = (Real{} + 1.0f) / dot(direction, direction);
        const Real nearest = Real{} - scale * dot(from, direction);
        const Three<Real> off = from + nearest * direction;
        const Real rest = (Real{} + sphere.radius * sphere.radius) - dot(off, off);
        const Real half = root(scale * select(greater(rest, Real{}), rest, Real{}));
        const Real begin = load<Real>(ray.tnear), end = load<Real>(ray.tfar);
        const Real first = nearest - half, second = nearest + half;
        t = select(greater(first, begin), first, second);
        met = valid & greater(rest, Real{}) & greater(t, begin) & greater(end, t);
        arm = from + t * direction;
    }
};

/// Stores a vector into one of Embree's arrays, in the lanes of the mask only.
template <typename Mask, typename Value, typename Field>
void store_some(const Mask& mask, Field& field, const Value& value) {
    store(field, select(mask, value, load<Value>(field)));
}

template <typename Kind>
void meet_all(const RTCIntersectFunctionNArguments* asked) {
    using Mask = typename Kind::Mask;
    auto& hits = *reinterpret_cast<typename Kind::Hits*>(asked->rayhit);
    Mask valid;
    std::memcpy(&valid, asked->valid, sizeof valid);
    const Meeting<Kind> meeting(sphere_at(asked->geometryUserPtr, asked->primID), hits.ray, valid);
    store_some(meeting.met, hits.ray.tfar, meeting.t);
    store_some(meeting.met, hits.hit.Ng_x, meeting.arm.x);
    store_some(meeting.met, hits.hit.Ng_y, meeting.arm.y);
    store_some(meeting.met, hits.hit.Ng_z, meeting.arm.z);
    store_some(meeting.met, hits.hit.geomID, Mask{} + static_cast<int>(asked->geomID));
    store_some(meeting.met, hits.hit.primID, Mask{} + static_cast<int>(asked->primID));
}

template <typename Kind>
void block_all(const RTCOccludedFunctionNArguments* asked) {
    using Real = typename Kind::Real;
    auto& rays = *reinterpret_cast<typename Kind::Rays*>(asked->ray);
    typename Kind::Mask valid;
    std::memcpy(&valid, asked->valid, sizeof valid);
    const Meeting<Kind> meeting(sphere_at(asked->geometryUserPtr, asked->primID), rays, valid);
    store_some(meeting.met, rays.tfar, Real{} - std::numeric_limits<float>::infinity());
}

void meet(const RTCIntersectFunctionNArguments* asked) {
    if (asked->N == 1) return meet_all<One>(asked);
    if (asked->N == 8) return meet_all<Eight>(asked);
    meet_all<Sixteen>(asked);
}
void block(const RTCOccludedFunctionNArguments* asked) {
    if (asked->N == 1) return block_all<One>(asked);
    if (asked->N == 8) return block_all<Eight>(asked);
    block_all<Sixteen>(asked);
}

} // namespace

RTCGeometry user_spheres(RTCDevice device, const std::vector<Sphere>& spheres) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(spheres.size()));
    rtcSetGeometryUserData(geometry, const_cast<Sphere*>(spheres.data()));
    rtcSetGeometryBoundsFunction(geometry, put_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, meet);
    rtcSetGeometryOccludedFunction(geometry, block);
    rtcCommitGeometry(geometry);
    return geometry;
}

} // namespace peers
