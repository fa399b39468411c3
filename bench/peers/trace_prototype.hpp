#pragma once

#include "peer_scene.hpp"
#include "plain.hpp"

namespace peers {

/// Simple Vulkan prototype of Whitted ray tracing in a compute shader (shaders/trace.comp), without
/// the engine's robustness. Its picture shows the same as the picture that is traced with Embree.
class RayTracingPrototype {
public:
    enum class PrototypeBvhKind {
        stack,     ///< the engine's BVH, walked with a stack in shared memory
        skip_links ///< the BVH as SkipLinkBvh, walked without a stack
    };
    /// Sets up the scene, view and depth of `peer`. The picture's width must be a power of two.
    RayTracingPrototype(catoptric::gpu::Device& device, catoptric::gpu::PipelineStore& pipelines,
                        const EmbreeWhittedTracer& peer,
                        std::span<const catoptric::bvh::Triangle> triangles, PrototypeBvhKind tree);

    /// Traces a picture and waits for the device.
    void trace_picture_with_prototype();
    std::vector<PeerVector3> read(); ///< returns the pixels of the last picture, linear

private:
    /// Push constants of shaders/trace.comp.
    struct TracePushConstants {
        catoptric::vec4 eye, forward, right, down, light, light_normal, intensity, grid;
    };
    void upload(const WhittedTracerScene& scene,
                std::span<const catoptric::bvh::Triangle> triangles, PrototypeBvhKind tree);

    catoptric::gpu::Device& peer_device_;
    catoptric::gpu::Buffer nodes_, triangles_, normals_, surfaces_, pixels_;
    GeneralLayoutVulkanImage picture_;
    PrototypeDescriptorSets sets_;
    BoundPrototypePipeline bound_;
    TracePushConstants view_{};
};

} // namespace peers
