#pragma once

#include "support/kernel.hpp"

#include <embree3/rtcore.h>

#include <span>
#include <vector>

namespace test {

/// Embree's robust mode on the CPU: a ray tracer by other people, in float as the device's walk is.
class Embree {
public:
    explicit Embree(std::span<const bvh::Triangle> triangles)
        : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        const std::size_t count = triangles.size();
        auto* corners = static_cast<vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3), 3 * count));
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), count));
        for (std::size_t i = 0; i < count; ++i) {
            corners[3 * i] = triangles[i].a, corners[3 * i + 1] = triangles[i].b,
                        corners[3 * i + 2] = triangles[i].c;
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
                indices[k] = static_cast<std::uint32_t>(k);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
        EXPECT_EQ(rtcGetDeviceError(device_), RTC_ERROR_NONE);
    }
    Embree(const Embree&) = delete;
    Embree& operator=(const Embree&) = delete;
    ~Embree() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    /// What each ray meets first; `object` and `steps` stay 0.
    std::vector<KernelHit> closest(const std::vector<KernelRay>& rays) const {
        std::vector<KernelHit> hits(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const KernelRay& ray = rays[i];
            RTCRayHit query{};
            query.ray.org_x = ray.origin.x, query.ray.org_y = ray.origin.y,
            query.ray.org_z = ray.origin.z;
            query.ray.dir_x = ray.direction.x, query.ray.dir_y = ray.direction.y,
            query.ray.dir_z = ray.direction.z;
            query.ray.tfar = ray.t_max;
            query.ray.mask = ~0u;
            query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            rtcIntersect1(scene_, &context, &query);
            if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
            hits[i] = {query.ray.tfar,
                       {1 - query.hit.u - query.hit.v, query.hit.u, query.hit.v},
                       query.hit.primID,
                       0,
                       1,
                       0};
        }
        return hits;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

} // namespace test
