#pragma once

#include "peer_scene.hpp"
#include "plain.hpp"

namespace peers {

/// Simple Vulkan prototype of Whitted ray tracing in a compute shader (shaders/trace.comp), without
/// the engine's robustness. Its picture shows the same as Embree's.
class TracePrototype {
public:
    enum class Tree {
        stack,     ///< the engine's BVH, walked with a stack in shared memory
        skip_links ///< the BVH as SkipLinks, walked without a stack
    };
    /// Sets up the scene, view and depth of `peer`. The picture's width must be a power of two.
    TracePrototype(catoptric::gpu::Device& device, catoptric::gpu::Pipelines& pipelines,
                   const PeerScene& peer, std::span<const catoptric::bvh::Triangle> triangles,
                   Tree tree);

    /// Traces a picture and waits for the device.
    void trace();
    std::vector<Vector> read(); ///< returns the pixels of the last picture, linear

private:
    /// Push constants of shaders/trace.comp.
    struct View {
        catoptric::vec4 eye, forward, right, down, light, light_normal, intensity, grid;
    };
    void upload(const Whitted& scene, std::span<const catoptric::bvh::Triangle> triangles,
                Tree tree);

    catoptric::gpu::Device& device_;
    catoptric::gpu::Buffer nodes_, triangles_, normals_, surfaces_, pixels_;
    PlainImage picture_;
    PlainSets sets_;
    Bound bound_;
    View view_{};
};

} // namespace peers
