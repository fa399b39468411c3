#pragma once

#include "render/passes.hpp"

/// Ray tracing from the camera: of a whole picture, or of the pixels that a view left to it.
namespace catoptric::reflect {

struct Tracer {
    enum class Shadow : std::uint32_t { none, map, ray }; ///< as in shaders/lib/bindings.glsl

    std::uint32_t depth = render::kReferenceDepth; ///< mirror bounces; beyond them black
    int samples = 1; ///< rays a pixel: 1 = its centre, n*n = a regular grid, else stratified
    Shadow shadow = Shadow::ray;
    render::Lighting lighting;  ///< with a map, where `shadow` is one
    bool exact_spheres = false; ///< balls as exact spheres, not as triangles
    bool doubles = false;       ///< hit points in double precision
    std::uint32_t without = 0;  ///< rule of robustness to leave out: shaders/lib/plain.glsl
};

struct Traced {
    graph::Image hdr; ///< linear radiance, rgba32f; alpha: what was met (shared::kMetBits)
    graph::Buffer counters;
};
Traced add_traced(graph::Graph& graph, const render::FrameInputs& inputs, const Tracer& tracer);

/// Lists the pixels of the view that were left to tracer `number`, from 1, and traces them into
/// `view.hdr`. Returns its shared::Counters.
graph::Buffer add_listed(graph::Graph& graph, const render::FrameInputs& inputs,
                         const Tracer& tracer, std::uint32_t number, const render::View& view);

} // namespace catoptric::reflect
