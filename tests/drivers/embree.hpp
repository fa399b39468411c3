#pragma once

#include "peers/embree_scene.hpp"
#include "support/kernel.hpp"

#include <span>
#include <vector>

namespace test {

/// Traces rays with Embree on the CPU, in its robust mode. Embree is an independent ray tracer that
/// computes in float, as the project's BVH traversal on the device does.
class EmbreeRayWitness {
public:
    explicit EmbreeRayWitness(std::span<const bvh::Triangle> triangles)
        : embree_scene_(device_, RTC_SCENE_FLAG_ROBUST, RTC_BUILD_QUALITY_MEDIUM) {
        embree_scene_.add_geometry_and_release(peers::make_triangle_geometry(device_, triangles));
        EXPECT_NO_THROW(embree_scene_.build_tree());
    }

    /// Returns the first hit of each ray. `object` and `steps` of a hit stay 0.
    std::vector<DeviceHit> find_closest_hits(const std::vector<DeviceRay>& rays) const {
        std::vector<DeviceHit> hits(rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const DeviceRay& ray = rays[i];
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
            rtcIntersect1(embree_scene_.embree_scene_handle(), &context, &query);
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
    peers::EmbreeDevice device_;
    peers::EmbreeScene embree_scene_;
};

} // namespace test
