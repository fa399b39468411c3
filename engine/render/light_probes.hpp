#pragma once

#include "render/passes.hpp"

/// Light between surfaces by light probes: small captures at the points of a grid, each of which
/// gives the irradiance at its place (shaders/lib/light_probes.glsl).
namespace catoptric::render {

/// Returns a grid over the bounds (scene units) of at most `most` probes, at least 8 or, in an open
/// scene, 27. All axes have about the same step, and at least two probes. Each probe lies in the
/// middle of a cell, so that none lies in an outer wall. An open scene (`is_open`) has a layer of
/// probes more around its bounds, since light also meets the outer surfaces.
shared::LightProbeGrid make_light_probe_grid(const Bounds<float>& bounds, std::size_t most,
                                             bool is_open);

/// The light probes of a frame.
struct LightProbes {
    shared::LightProbeGrid grid;
    graph::ImageHandle colours, depths; ///< of the captures: rgba16f, and distances as r32f
    LightProbeImages images;
    std::string note; ///< sentence that says how the grid differs from the request; else empty

    std::uint32_t count() const { return grid.counts.x * grid.counts.y * grid.counts.z; }
};

/// Declares the images of at most `most` light probes.
LightProbes declare_light_probes(graph::Graph& graph, const FrameInputs& inputs,
                                 std::uint32_t most);

/// Declares a pass for each probe, which draws the scene around it without lamps and glass, and one
/// that computes LightProbes::images. The captures are lit by `lighting` and by the probes of
/// the frame before, so frame k shows k reflections between diffuse surfaces; lamps would otherwise
/// count twice, since they light surfaces as points. `looks`: shaders of mirrors. The captures have
/// kLightProbeFace texels an edge. Costs O(probes * objects) on the host.
void add_light_probe_passes(graph::Graph& graph, const FrameInputs& inputs,
                            const LightProbes& probes, ShadingLights lighting,
                            ShaderOfEachMirror looks);

} // namespace catoptric::render
