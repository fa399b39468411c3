#pragma once

#include "app/bench.hpp"
#include "measure/picture.hpp"
#include "peer_scene.hpp"

#include <memory>
#include <string>

/// A day's plain Vulkan code for what our passes do, on the same device: what our promises cost.
namespace peers {

/// "prototype/stack", "prototype/links" and "prototype/FACE".
class Prototypes {
public:
    /// Of the request's scene and view. `mesh`: the same without exact spheres.
    Prototypes(const catoptric::app::Request& request, const PeerScene& mesh);
    ~Prototypes();
    Prototypes(const Prototypes&) = delete;
    Prototypes& operator=(const Prototypes&) = delete;

    /// Names of those that trace.
    static std::vector<std::string> tracers();
    /// The prototype for our row with captures of this edge.
    static std::string name_of(int face) { return "prototype/" + std::to_string(face); }

    /// Frames, each until it is done; must not outlive this.
    std::vector<catoptric::app::Subject> subjects(int warmup);
    /// The picture of the last frame, linear. Throws where there is no such prototype.
    std::vector<Vector> read(const std::string& name);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace peers
