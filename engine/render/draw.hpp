#pragma once

#include "render/mirror_shaders.hpp"

#include <functional>

/// Draws objects of a scene: what the bodies of raster passes are made of.
namespace catoptric::render {

/// Which objects are drawn, by their index.
using Wanted = std::function<bool(std::size_t)>;

/// Some triangles of an object; null: all.
using Triangles = const std::vector<scene::TriangleRun>*;

/// The objects that are asked for, with this fragment shader and state, into the layers whose views
/// they may meet: views from `first_view` on. Those in spaces of their own come last.
void draw_objects(graph::Commands& commands, const GpuScene& scene, gpu::RasterState state,
                  std::uint32_t first_view, std::uint32_t layers, std::uint32_t ablated,
                  const Wanted& wanted, Triangles triangles = nullptr);

/// The same without triangles that face away of what hides its own back. Not for what is looked at
/// behind a first layer.
void draw_fronts(graph::Commands& commands, const GpuScene& scene, gpu::RasterState state,
                 std::uint32_t first_view, std::uint32_t layers, std::uint32_t ablated,
                 const Wanted& wanted, Triangles triangles = nullptr);

/// What a picture of the scene is made with.
struct Drawing {
    std::uint32_t first_view = 0, layers = 1;
    Lighting lighting;
    std::shared_ptr<const Looks> looks; ///< of mirrors
    gpu::Constants store;               ///< how distances are kept, and what else
    std::optional<graph::Image>
        peeled; ///< the distances of a first layer: only what lies behind them is drawn
};

/// Everything that is no mirror, then the mirrors, of what is wanted.
void draw_scene(graph::Commands& commands, const GpuScene& scene, const Drawing& drawing,
                const Wanted& wanted);

} // namespace catoptric::render
