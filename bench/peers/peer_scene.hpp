#pragma once

#include "app/run.hpp"
#include "embree_scene.hpp"
#include "whitted.hpp"

namespace peers {

/// A request's scene for Embree: its triangles and, where `exact`, balls in place of those that
/// stand for one. Only what the built-in scene has is understood: one lamp, materials of one
/// colour, mirrors that reflect the same at any angle, a perspective camera.
class PeerScene {
public:
    PeerScene(const EmbreeDevice& device, const catoptric::app::Request& request, int depth,
              bool exact);

    const Whitted& whitted() const { return whitted_; }
    Traced trace(int width, int threads) const { return peers::trace(whitted_, width, threads); }

private:
    void add_objects(const EmbreeDevice& device, const catoptric::app::Request& request,
                     bool exact);
    void add_view(const catoptric::app::Request& request);

    EmbreeScene tree_;
    Whitted whitted_;
};

/// All triangles of a scene at rest, in its scene units.
std::vector<catoptric::bvh::Triangle> triangles_of(const catoptric::scene::Scene& scene);

} // namespace peers
