#pragma once

#include "graph/graph.hpp"

#include <string>

/// Render graphs of any size, for tests of the planner. Their passes record no commands.
namespace test {

using namespace catoptric;

/// Returns the graph that technique `reuse` declares for this number of mirrors: a shadow pass, one
/// capture pass per mirror, a view pass and a compose pass. Each capture reads the cubes of the
/// last frame.
inline graph::Graph make_reuse_graph(std::uint32_t mirrors) {
    using graph::ResourceUse;
    constexpr graph::ClearValue kBlackClearValue{};
    const auto nothing = [](graph::PassCommands&) {};
    graph::Graph g;
    const auto add = [&](const std::string& name, TexelFormat format, std::uint32_t layers,
                         bool cube) {
        return g.add_image({name, format, 64, 64, layers, cube});
    };
    const graph::ImageHandle shadow = add("shadow", TexelFormat::d32f, 5, false);
    const graph::ImageHandle cubes = add("cubes", TexelFormat::rgba16f, 6 * mirrors, true);
    const graph::ImageHandle distance = add("distance", TexelFormat::r32f, 6 * mirrors, true);
    const graph::ImageHandle hdr = add("hdr", TexelFormat::rgba32f, 1, false);
    const graph::ImageHandle view_depth = add("view.depth", TexelFormat::d32f, 1, false);
    const graph::ImageHandle display = add("display", TexelFormat::rgba8_unorm, 1, false);
    g.add_pass("shadow", graph::PassPurpose::scene)
        .writes(shadow, ResourceUse::depth, kBlackClearValue)
        .layers(5)
        .record(nothing);
    for (std::uint32_t n = 0; n < mirrors; ++n) {
        const std::string name = "capture/" + std::to_string(n + 1);
        const graph::ImageHandle depth = add(name + ".depth", TexelFormat::d32f, 6, true);
        g.add_pass(name, graph::PassPurpose::scene)
            .reads(shadow, ResourceUse::sampled)
            .reads(g.previous(cubes), ResourceUse::sampled)
            .writes(cubes.layers(6 * n, 6), ResourceUse::colour, kBlackClearValue)
            .writes(distance.layers(6 * n, 6), ResourceUse::colour, kBlackClearValue)
            .writes(depth, ResourceUse::depth, kBlackClearValue)
            .layers(6)
            .record(nothing);
    }
    g.add_pass("view", graph::PassPurpose::scene)
        .reads(shadow, ResourceUse::sampled)
        .reads(cubes, ResourceUse::sampled)
        .reads(distance, ResourceUse::sampled)
        .writes(hdr, ResourceUse::colour, kBlackClearValue)
        .writes(view_depth, ResourceUse::depth, kBlackClearValue)
        .record(nothing);
    g.add_pass("compose")
        .reads(hdr, ResourceUse::sampled)
        .writes(display, ResourceUse::storage_write)
        .record(nothing);
    g.output(hdr);
    g.output(display);
    return g;
}

} // namespace test
