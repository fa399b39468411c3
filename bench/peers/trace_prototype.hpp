#pragma once

#include "peer_scene.hpp"
#include "plain.hpp"

namespace peers {

/// Whitted ray tracing as a day's plain Vulkan code has it: what Embree's picture shows, in a
/// compute shader without what our own promises (shaders/trace.comp).
class TracePrototype {
public:
    enum class Tree {
        stack,     ///< engine/bvh's, whose walk keeps what waits in shared memory
        skip_links ///< SkipLinks
    };
    /// The scene of `peer`, its view and depth. The width of its picture is a power of two.
    TracePrototype(catoptric::gpu::Device& device, catoptric::gpu::Pipelines& pipelines,
                   const PeerScene& peer, std::span<const catoptric::bvh::Triangle> triangles,
                   Tree tree);

    /// Until it is done.
    void trace();
    std::vector<Vector> read(); ///< the last picture's

private:
    /// Push constants.
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
