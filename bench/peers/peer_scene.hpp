#pragma once

#include "embree_scene.hpp"
#include "render/geometry.hpp"
#include "session/run.hpp"
#include "whitted.hpp"

namespace peers {

/// A request's scene for Embree. With `exact`, spheres replace the meshes that approximate them.
/// Supports only the features of the scenes `cornell-mirrors` and `room`. These are lamps, spots
/// without a range, mirrors with the same reflectance at any angle and smooth dielectrics. Further
/// features are bilinear repeating sRGB textures of albedo, and a perspective camera.
class EmbreeWhittedTracer {
public:
    EmbreeWhittedTracer(const EmbreeDevice& device, const catoptric::session::Request& request,
                        int depth, bool exact);

    const WhittedTracerScene& whitted_tracer_scene() const { return whitted_; }
    PeerTracedPicture trace_picture(int width, int threads) const {
        return peers::trace_whitted_picture(whitted_, width, threads);
    }

private:
    void add_objects(const EmbreeDevice& device, const catoptric::session::Request& request,
                     bool exact);
    void add_triangles(const catoptric::render::FrameGeometry& geometry, std::size_t object,
                       std::vector<catoptric::bvh::Triangle>& triangles);
    void add_view(const catoptric::session::Request& request);

    EmbreeScene embree_tree_;
    WhittedTracerScene whitted_;
};

/// Returns all triangles of a scene at time 0, in scene units.
std::vector<catoptric::bvh::Triangle>
make_bvh_triangles_of_scene(const catoptric::scene::Scene& scene);

} // namespace peers
