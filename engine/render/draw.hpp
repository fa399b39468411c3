#pragma once

#include "render/mirror_shaders.hpp"

#include <functional>
#include <span>

/// Functions that record the draws of scene objects into a raster pass.
namespace catoptric::render {

void bind_lighting(graph::PassCommands& commands, const ShadingLights& lighting);

/// Returns whether an object, given by its index, is drawn.
using ObjectFilter = std::function<bool(std::size_t)>;

/// The part of each object to draw.
struct DrawnParts {
    /// Runs of triangles to draw; null: all triangles.
    const std::vector<scene::TriangleRun>* triangles = nullptr;
    /// For each object, the layers to draw it into: bit k stands for layer k (shown_faces.hpp).
    /// Empty: all layers whose views may meet the object.
    std::span<const std::uint8_t> layers;
};

/// Numbers of a mirror's shader that may change from frame to frame: members of
/// shared::DrawParameters.
struct MirrorDrawNumbers {
    std::uint32_t ablated = 0;
    vec4 shown{0};
};

/// Draws the wanted objects with this fragment shader and state. Draws each object into those
/// layers whose views may meet it; the views start at `first_view`. Draws objects with an object
/// space last.
void draw_objects(graph::PassCommands& commands, const GpuScene& scene, gpu::RasterState state,
                  std::uint32_t first_view, std::uint32_t layers, const MirrorDrawNumbers& numbers,
                  const ObjectFilter& wanted, const DrawnParts& parts = {});

/// Draws as draw_objects does, but without back faces of objects that hide their own back. Not
/// valid for depth peeling, which shows surfaces behind a first layer.
void draw_without_back_faces(graph::PassCommands& commands, const GpuScene& scene,
                             gpu::RasterState state, std::uint32_t first_view, std::uint32_t layers,
                             const MirrorDrawNumbers& numbers, const ObjectFilter& wanted,
                             const DrawnParts& parts = {});

struct DrawSettings {
    std::uint32_t first_view = 0, layers = 1;
    ShadingLights lighting;
    std::shared_ptr<const MirrorShaders> looks;
    gpu::ShaderConstants store; ///< constants for storing distances and surfaces
    ShadingTracer completing_tracer;
    /// Distances of a first layer; only surfaces behind them are drawn.
    std::optional<graph::ImageHandle> peeled;
};

/// Draws all wanted objects: non-mirrors first, then mirrors. Captures in scenes with many mirrors
/// draw the mirrors first. `layers`: see DrawnParts.
void draw_scene(graph::PassCommands& commands, const GpuScene& scene, const DrawSettings& drawing,
                const ObjectFilter& wanted, std::span<const std::uint8_t> layers = {});

/// Draws the parts of blended objects that are not opaque over the finished picture. Call it after
/// draw_scene and draw_sky, with the same arguments. Draws nothing in a second layer of a capture,
/// or if the ray tracer completes the picture.
void draw_blended_surfaces(graph::PassCommands& commands, const GpuScene& scene,
                           const DrawSettings& drawing, const ObjectFilter& wanted,
                           std::span<const std::uint8_t> layers = {});

/// Stores the distances of blended surfaces in a capture, where their alpha exceeds `alpha`, and
/// the mark kBlendedSurface for the number of the surface. Call it after draw_blended_surfaces,
/// with the same arguments.
void draw_blended_distances(graph::PassCommands& commands, const GpuScene& scene,
                            const DrawSettings& drawing, float alpha, const ObjectFilter& wanted,
                            std::span<const std::uint8_t> layers = {});

} // namespace catoptric::render
