#pragma once

#include "render/frame_inputs.hpp"

/// Functions that find which share of the hemisphere above each surface of the camera's view near
/// surfaces leave visible, weighted by the cosine (knob `ao=screen`). This share of the light of
/// environment, ambient light and light probes reaches the surface.
namespace catoptric::render {

/// Returns the distance up to which surfaces hide light from other surfaces, in world units: an
/// eighth of the diagonal of the scene's core (scene/scene_core.hpp). All frames of a scene have
/// the same distance.
double occlusion_radius(const GpuScene& scene);

/// Declares three passes: one draws normals and distances of the camera's view, without glass and
/// without the parts of blended surfaces that are not opaque; one computes horizon angles of each
/// pixel; one takes the mean over neighbouring pixels. Returns the visible share of the hemisphere
/// in each pixel, 0 to 1, as an image of r32f. Surfaces outside the picture, and surfaces hidden in
/// it, hide nothing. The passes count as no scene pass. They take 28 bytes a pixel besides the
/// result.
graph::ImageHandle add_ambient_occlusion(graph::Graph& graph, const FrameInputs& inputs);

} // namespace catoptric::render
