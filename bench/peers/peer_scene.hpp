#pragma once

#include "app/run.hpp"
#include "embree_scene.hpp"
#include "render/geometry.hpp"
#include "whitted.hpp"

namespace peers {

/// A request's scene for Embree: its triangles and, where `exact`, balls in place of those that
/// stand for one. Only what the built-in scene and `room` have is understood: lamps and spots
/// without a range, mirrors that reflect the same at any angle, smooth dielectrics, textures of
/// albedo in sRGB that are mixed and repeat, a perspective camera, no surroundings.
class PeerScene {
public:
    PeerScene(const EmbreeDevice& device, const catoptric::app::Request& request, int depth,
              bool exact);

    const Whitted& whitted() const { return whitted_; }
    Traced trace(int width, int threads) const { return peers::trace(whitted_, width, threads); }

private:
    void add_objects(const EmbreeDevice& device, const catoptric::app::Request& request,
                     bool exact);
    void add_triangles(const catoptric::render::Geometry& geometry, std::size_t object,
                       std::vector<catoptric::bvh::Triangle>& triangles);
    void add_view(const catoptric::app::Request& request);

    EmbreeScene tree_;
    Whitted whitted_;
};

/// All triangles of a scene at rest, in its scene units.
std::vector<catoptric::bvh::Triangle> triangles_of(const catoptric::scene::Scene& scene);

} // namespace peers
