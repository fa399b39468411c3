#pragma once

#include "render/passes.hpp"

/// Functions that compute light on surfaces by light probes: small captures at the points of a
/// grid, each of which gives the irradiance at its point (shaders/lib/light_probes.glsl).
namespace catoptric::render {

/// Returns a grid of light probes over the bounds (scene units). The grid has at most `most`
/// points, and at least 8, or 27 in an open scene. All axes have about the same step, and at least
/// two probes. Each probe lies in the middle of a cell, so that none lies in an outer wall. An open
/// scene (`is_open`) has a layer of probes more around its bounds, since light also meets the outer
/// surfaces.
shared::LightProbeGrid make_probe_grid(const Bounds<float>& bounds, std::size_t most, bool is_open);

/// The light probes of a frame.
struct LightProbes {
    shared::LightProbeGrid grid;
    graph::ImageHandle colours, depths; ///< images of the captures: colours rgba16f, distances r32f
    LightProbeImages images;
    std::string note; ///< sentence that says how the grid differs from the request; else empty

    std::uint32_t count() const { return grid.counts.x * grid.counts.y * grid.counts.z; }
};

/// Declares the images of at most `most` light probes. `content`: shared::kLightProbesOfSurfaces or
/// kLightProbesOfEnvironment.
LightProbes declare_light_probes(graph::Graph& graph, const FrameInputs& inputs, std::uint32_t most,
                                 std::uint32_t content);

/// Declares two kinds of passes. For each light probe, one pass draws the scene around the probe
/// without glass. One further pass computes LightProbes::images. Lamps are drawn without their
/// emission, because they light surfaces as points and would count twice. The captures are lit by
/// `lighting` and by the light probes of the previous frame, so frame k shows k reflections between
/// diffuse surfaces. Light probes of the environment hold no light of surfaces: their captures are
/// unlit, and blended surfaces hide nothing. `looks`: shaders of mirrors. The captures have
/// kLightProbeFace texels an edge. Takes O(probes * objects) on the host.
void add_light_probes(graph::Graph& graph, const FrameInputs& inputs, const LightProbes& probes,
                      ShadingLights lighting, MirrorShaders looks);

} // namespace catoptric::render
