#pragma once

#include "bvh/bvh.hpp"
#include "plain.hpp"
#include "rays.hpp"

namespace peers {

/// The engine's own walk (shaders/lib/trace.glsl) over rays of a list.
class RayList {
public:
    /// A multiple of 64 rays.
    RayList(catoptric::gpu::Device& device, catoptric::gpu::Pipelines& pipelines,
            std::span<const catoptric::bvh::Triangle> triangles, std::span<const Ray> rays);

    /// Until it is done.
    void trace();
    std::vector<Met> read() const; ///< of the last time

private:
    catoptric::gpu::Device& device_;
    catoptric::gpu::Buffer nodes_, triangles_, rays_, met_;
    PlainSets sets_;
    Bound bound_;
    std::uint32_t groups_;
};

} // namespace peers
