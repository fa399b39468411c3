#pragma once

#include "benchmark/bench.hpp"
#include "measure/picture.hpp"
#include "peer_scene.hpp"

#include <memory>
#include <string>

/// Simple Vulkan prototypes that do the work of our passes on the same device. They show the cost
/// of the engine's robustness and generality.
namespace peers {

/// The prototypes: "prototype/stack" and "prototype/links" trace rays with two forms of tree.
/// "prototype/FACE" draws captures with faces of FACE texels.
class PrototypeFrameRenderer {
public:
    /// Sets up all prototypes for the request's scene and view. `mesh` is the same scene without
    /// exact spheres.
    PrototypeFrameRenderer(const catoptric::session::Request& request,
                           const EmbreeWhittedTracer& mesh);
    ~PrototypeFrameRenderer();
    PrototypeFrameRenderer(const PrototypeFrameRenderer&) = delete;
    PrototypeFrameRenderer& operator=(const PrototypeFrameRenderer&) = delete;

    /// Returns the names of the prototypes that trace rays.
    static std::vector<std::string> tracers();
    /// Returns the name of the prototype with captures of this edge, texels.
    static std::string prototype_benchmark_name(int face) {
        return "prototype/" + std::to_string(face);
    }

    /// Returns benchmarks that each draw a frame and wait for the device. They must not outlive the
    /// prototypes.
    std::vector<catoptric::benchmark::Subject> subjects(int warmup);
    /// Returns a prototype's picture of its last frame, linear. Throws if no prototype has the
    /// name.
    std::vector<PeerVector3> read(const std::string& name);

private:
    struct Impl;
    std::unique_ptr<Impl> prototype_impl_;
};

} // namespace peers
