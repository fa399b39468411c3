#pragma once

#include "drivers/ray_query_device.hpp"
#include "support/kernel.hpp"

#include <span>
#include <vector>

namespace test {

/// Traces rays with the ray queries of the driver, in a compute pipeline (ray_query.comp).
class DriverRayQuery {
public:
    explicit DriverRayQuery(const RayQueryDevice& device);

    /// Returns the first hit of each ray. `object` and `steps` of a hit stay 0.
    std::vector<DeviceHit> find_closest_hits(std::span<const bvh::Triangle> triangles,
                                             const std::vector<DeviceRay>& rays) const;

private:
    struct AccelerationStructure;
    AccelerationStructure build(VkAccelerationStructureTypeKHR type,
                                const VkAccelerationStructureGeometryKHR& geometry,
                                std::uint32_t primitives) const;
    AccelerationStructure bottom(const RayQueryMemory& corners, std::uint32_t triangles) const;
    AccelerationStructure top(const AccelerationStructure& bottom) const;
    void trace(const AccelerationStructure& triangles, const RayQueryMemory& rays,
               const RayQueryMemory& hits, std::uint32_t count) const;
    void destroy(const AccelerationStructure& structure) const;

    const RayQueryDevice& device_;
    gpu::UniqueDescriptorSetLayout set_layout_;
    gpu::UniquePipelineLayout pipeline_layout_;
    gpu::UniquePipeline pipeline_;
};

} // namespace test
