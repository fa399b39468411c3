#pragma once

#include "graph/graph.hpp"

#include <string>

/// Render graphs of any size, for tests of the planner. Their passes record no commands.
namespace test {

using namespace catoptric;

/// Returns the graph that technique `reuse` declares for this number of mirrors: a shadow pass, one
/// capture pass per mirror, a view pass and a compose pass. Each capture reads the cubes of the
/// last frame.
inline graph::Graph reuse_frame(std::uint32_t mirrors) {
    using graph::Use;
    constexpr graph::Clear kBlack{};
    const auto nothing = [](graph::Commands&) {};
    graph::Graph g;
    const auto add = [&](const std::string& name, Format format, std::uint32_t layers, bool cube) {
        return g.image({name, format, 64, 64, layers, cube});
    };
    const graph::ImageHandle shadow = add("shadow", Format::d32f, 5, false);
    const graph::ImageHandle cubes = add("cubes", Format::rgba16f, 6 * mirrors, true);
    const graph::ImageHandle distance = add("distance", Format::r32f, 6 * mirrors, true);
    const graph::ImageHandle hdr = add("hdr", Format::rgba32f, 1, false);
    const graph::ImageHandle view_depth = add("view.depth", Format::d32f, 1, false);
    const graph::ImageHandle display = add("display", Format::rgba8_unorm, 1, false);
    g.pass("shadow", graph::Tag::scene)
        .writes(shadow, Use::depth, kBlack)
        .layers(5)
        .record(nothing);
    for (std::uint32_t n = 0; n < mirrors; ++n) {
        const std::string name = "capture/" + std::to_string(n + 1);
        const graph::ImageHandle depth = add(name + ".depth", Format::d32f, 6, true);
        g.pass(name, graph::Tag::scene)
            .reads(shadow, Use::sampled)
            .reads(g.previous(cubes), Use::sampled)
            .writes(cubes.layers(6 * n, 6), Use::colour, kBlack)
            .writes(distance.layers(6 * n, 6), Use::colour, kBlack)
            .writes(depth, Use::depth, kBlack)
            .layers(6)
            .record(nothing);
    }
    g.pass("view", graph::Tag::scene)
        .reads(shadow, Use::sampled)
        .reads(cubes, Use::sampled)
        .reads(distance, Use::sampled)
        .writes(hdr, Use::colour, kBlack)
        .writes(view_depth, Use::depth, kBlack)
        .record(nothing);
    g.pass("compose").reads(hdr, Use::sampled).writes(display, Use::storage_write).record(nothing);
    g.mark_output(hdr);
    g.mark_output(display);
    return g;
}

} // namespace test
