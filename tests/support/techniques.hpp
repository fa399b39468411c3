#pragma once

#include "reflect/frame.hpp"

#include <string>

/// Adds the passes of techniques and captures to a graph, without a session.
namespace test {

using namespace catoptric;

/// Adds the passes of a frame in which one technique draws all mirrors.
inline reflect::TechniqueOutputs add_technique(graph::Graph& graph,
                                               const render::FrameInputs& inputs,
                                               const std::string& technique) {
    return reflect::add_frame_passes(
        graph, inputs,
        reflect::assign_techniques(
            reflect::parse_plan(technique),
            std::vector<std::string>(inputs.scene.mirror_count(), "mirror")));
}

/// Adds passes that capture all mirrors. Mirrors in these captures are black.
inline render::CubeCaptureArray add_black_captures(graph::Graph& graph,
                                                   const render::FrameInputs& inputs,
                                                   const render::CaptureOptions& options) {
    const render::MirrorCaptures captures = render::declare_capture_images(
        graph, inputs, "capture", std::vector(inputs.scene.mirror_count(), options));
    render::add_captures(graph, inputs, captures, render::use_same_shader(inputs.scene, {}));
    return captures.arrays.front();
}

} // namespace test
