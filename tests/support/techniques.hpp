#pragma once

#include "reflect/frame.hpp"

#include <string>

/// Passes of techniques and captures without a session around them.
namespace test {

using namespace catoptric;

/// One technique for all mirrors.
inline reflect::Outputs add_technique(graph::Graph& graph, const render::FrameInputs& inputs,
                                      const std::string& technique) {
    return reflect::add_frame(
        graph, inputs,
        reflect::assign(reflect::parse_plan(technique),
                        std::vector<std::string>(inputs.scene.mirror_count(), "mirror")));
}

/// Captures of all mirrors, in which the others are black.
inline render::Cubes add_black_captures(graph::Graph& graph, const render::FrameInputs& inputs,
                                        const render::CaptureOptions& options) {
    const render::Captures captures = render::declare_captures(
        graph, inputs, "capture", std::vector(inputs.scene.mirror_count(), options));
    render::add_captures(graph, inputs, captures, render::same_shader(inputs.scene, {}));
    return captures.arrays.front();
}

} // namespace test
