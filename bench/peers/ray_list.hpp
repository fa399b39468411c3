#pragma once

#include "bvh/bvh.hpp"
#include "plain.hpp"
#include "rays.hpp"

namespace peers {

/// Traces a list of rays with the engine's BVH walk (shaders/lib/trace.glsl).
class RayList {
public:
    /// Builds the tree and uploads the rays. The number of rays must be a multiple of 64.
    RayList(catoptric::gpu::Device& device, catoptric::gpu::Pipelines& pipelines,
            std::span<const catoptric::bvh::Triangle> triangles, std::span<const Ray> rays);

    /// Traces all rays and waits for the device.
    void trace();
    std::vector<Met> read() const; ///< returns the hits of the last `trace`

private:
    catoptric::gpu::Device& device_;
    catoptric::gpu::Buffer nodes_, triangles_, rays_, met_;
    PlainSets sets_;
    Bound bound_;
    std::uint32_t groups_;
};

} // namespace peers
