#pragma once

#include "peer_scene.hpp"
#include "plain.hpp"

namespace peers {

/// Simple Vulkan prototype of Whitted ray tracing in a compute shader (shaders/trace.comp), without
/// the engine's robustness. Its picture shows the same as Embree's.
class TracePrototype {
public:
    enum class PrototypeTreeKind {
        stack,     ///< the engine's BVH, walked with a stack in shared memory
        skip_links ///< the BVH as SkipLinkTree, walked without a stack
    };
    /// Sets up the scene, view and depth of `peer`. The picture's width must be a power of two.
    TracePrototype(catoptric::gpu::GpuDevice& device, catoptric::gpu::PipelineStore& pipelines,
                   const EmbreePeerScene& peer, std::span<const catoptric::bvh::Triangle> triangles,
                   PrototypeTreeKind tree);

    /// Traces a picture and waits for the device.
    void trace_prototype_picture();
    std::vector<PeerVector> read(); ///< returns the pixels of the last picture, linear

private:
    /// Push constants of shaders/trace.comp.
    struct TracePushConstants {
        catoptric::vec4 eye, forward, right, down, light, light_normal, intensity, grid;
    };
    void upload(const WhittedScene& scene, std::span<const catoptric::bvh::Triangle> triangles,
                PrototypeTreeKind tree);

    catoptric::gpu::GpuDevice& peer_device_;
    catoptric::gpu::GpuBuffer nodes_, triangles_, normals_, surfaces_, pixels_;
    GeneralLayoutImage picture_;
    PlainDescriptorSets sets_;
    BoundPlainPipeline bound_;
    TracePushConstants view_{};
};

} // namespace peers
