#pragma once

#include "support/device.hpp"

#include <cmath>

/// Frames with known numbers: passes of shaders/tests/start.comp and step.comp on small images of
/// one float, and the same computations in C++.
namespace test {

using graph::ResourceUse;

constexpr std::uint32_t kStepImageWidth = 40, kHeight = 24;

inline graph::ImageHandle add_step_image(graph::Graph& graph, const std::string& name) {
    return graph.add_image({name, TexelFormat::r32f, kStepImageWidth, kHeight});
}

/// Adds a pass that sets each texel of `after` to number * (1 + the texel's index).
inline void add_start_pass(graph::Graph& graph, graph::ImageHandle after, float number) {
    graph.add_pass("start/" + graph.images()[after.id].name)
        .writes(after, ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/start.comp", {}});
            commands.bind("after", after);
            commands.push_constants(number);
            commands.dispatch((kStepImageWidth + 7) / 8, (kHeight + 7) / 8);
        });
}

inline void add_step_pass(graph::Graph& graph, const std::string& name, graph::ImageHandle before,
                          graph::ImageHandle after, float number) {
    graph.add_pass(name)
        .reads(before, ResourceUse::sampled)
        .writes(after, ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            commands.bind_pipeline(gpu::ComputeState{"tests/step.comp", {}});
            commands.bind("before", before);
            commands.bind("after", after);
            commands.push_constants(number);
            commands.dispatch((kStepImageWidth + 7) / 8, (kHeight + 7) / 8);
        });
}

/// Returns the values that start.comp writes.
inline std::vector<float> expected_start_texels(float number) {
    std::vector<float> values;
    for (std::size_t i = 0; i < kStepImageWidth * kHeight; ++i)
        values.push_back(number * static_cast<float>(1 + i));
    return values;
}

/// Returns the values that step.comp computes from `values`.
inline std::vector<float> expected_step_texels(std::vector<float> values, float number) {
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = std::fmod(3 * values[i] + static_cast<float>(i) + number, 1048576.0f);
    return values;
}

} // namespace test
