#pragma once

#include "render/passes.hpp"

/// Ray tracing from the camera, of a whole picture or of selected pixels of a view.
namespace catoptric::reflect {

struct TracerSettings {
    /// Methods of shadows, numbered as in shaders/lib/bindings.glsl.
    enum class Shadow : std::uint32_t { none, map, ray };

    std::uint32_t depth = render::kReferenceBounces; ///< mirror bounces; longer paths end black
    int samples = 1; ///< rays per pixel: 1 = its centre, n*n = a regular grid, else stratified
    /// Rays from the first rough surface that a camera ray meets, in directions drawn from its
    /// lobe. 0: rough surfaces reflect sharply.
    std::uint32_t rays = 0;
    /// Whether a ray to a point drawn on a lamp goes with each ray of a lobe
    /// (shaders/lib/lamps.glsl).
    bool samples_lamps = true;
    /// Whether rays leave diffuse surfaces as well, so that light between surfaces, the shadows of
    /// the environment and the area of lamps count (shaders/lib/paths.glsl). Needs `rays` > 0.
    bool paths = false;
    /// Seed of these directions, in addition to FrameInputs::seed.
    std::uint32_t seed = 0;
    Shadow shadow = Shadow::ray;
    /// Has a shadow map if `shadow` is `map`. With `first_raster` and `ray`, a shadow map here
    /// spares the shadow rays where it can tell alone.
    render::ShadingLights lighting;
    bool exact_spheres = false; ///< intersects exact spheres instead of their triangles
    /// Camera rays of listed pixels start at the triangle that the view drew in their pixel. The
    /// view's shaders write its number (shaders/lib/first_hit.glsl). One sample only.
    bool first_raster = false;
    bool doubles = false;      ///< hit points in double precision
    std::uint32_t without = 0; ///< number of a robustness rule to disable: shaders/lib/plain.glsl
};

struct TracedPicture {
    graph::ImageHandle hdr; ///< linear radiance, rgba32f; alpha says which surface the ray met
                            ///< (shared::kBitsPerMirrorHit)
    graph::BufferHandle counters;
};
TracedPicture add_picture_tracing(graph::Graph& graph, const render::FrameInputs& inputs,
                                  const TracerSettings& tracer);

/// Images of what the camera ray through each pixel's centre meets first
/// (shaders/first_surface.comp).
struct FirstSurfaceImages {
    graph::ImageHandle normals_and_distances; ///< rgba32f; scene units along the ray
    /// Word with the object's number from 1 (bvh::unpack_number), 0: none; factor that a
    /// texture gives the roughness. rgba32f.
    graph::ImageHandle objects_and_roughness;
    graph::BufferHandle counters; ///< shared::Counters
};
/// Declares the pass that traces these rays. All spheres are triangles, as in the rasteriser.
FirstSurfaceImages add_first_surface(graph::Graph& graph, const render::FrameInputs& inputs);

/// Lists the pixels of the view that are marked for tracer `number`, from 1, and traces them into
/// `view.hdr`. Returns the shared::Counters of the tracing.
graph::BufferHandle add_list_tracing(graph::Graph& graph, const render::FrameInputs& inputs,
                                     const TracerSettings& tracer, std::uint32_t number,
                                     const render::CameraOutputs& view);

} // namespace catoptric::reflect
