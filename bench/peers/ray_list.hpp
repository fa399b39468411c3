#pragma once

#include "bvh/bvh.hpp"
#include "plain.hpp"
#include "rays.hpp"

namespace peers {

/// Traces a list of rays with the engine's BVH walk (shaders/lib/trace.glsl).
class RayListBenchmark {
public:
    /// Builds the tree and uploads the rays. The number of rays must be a multiple of 64.
    RayListBenchmark(catoptric::gpu::Device& device, catoptric::gpu::PipelineStore& pipelines,
                     std::span<const catoptric::bvh::Triangle> triangles,
                     std::span<const Ray> rays);

    /// Traces all rays and waits for the device.
    void trace_all_rays();
    std::vector<FirstRayHit> read() const; ///< returns the hits of the last `trace_all_rays`

private:
    catoptric::gpu::Device& peer_device_;
    catoptric::gpu::Buffer nodes_, triangles_, rays_, met_;
    PrototypeDescriptorSets sets_;
    BoundPrototypePipeline bound_;
    std::uint32_t groups_;
};

} // namespace peers
