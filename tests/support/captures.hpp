#pragma once

#include "render/passes.hpp"
#include "support/device.hpp"
#include "support/half.hpp"
#include "support/scenes.hpp"

#include <cstring>
#include <ostream>
#include <vector>

namespace catoptric {

/// How a test's parameter is shown.
inline void PrintTo(Format format, std::ostream* out) { *out << name_of(format); }

} // namespace catoptric

/// Cube captures as numbers.
namespace test {

/// What render::add_captures made of every mirror of a scene.
struct Captured {
    std::uint32_t face = 0;
    std::vector<std::byte> colour_bytes, distance_bytes;
    render::Space space;

    /// Texel (x, y) of face 0..5 of a mirror from 0.
    vec3 colour(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const {
        std::uint16_t halves[4];
        std::memcpy(halves, colour_bytes.data() + 8 * index(mirror, cube_face, x, y), 8);
        return {from_half(halves[0]), from_half(halves[1]), from_half(halves[2])};
    }
    float distance(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y, Format format) const {
        const std::size_t i = index(mirror, cube_face, x, y);
        if (format == Format::r8_unorm) return static_cast<float>(distance_bytes[i]) / 255;
        if (format == Format::r16f) {
            std::uint16_t half;
            std::memcpy(&half, distance_bytes.data() + 2 * i, 2);
            return from_half(half);
        }
        float value;
        std::memcpy(&value, distance_bytes.data() + 4 * i, 4);
        return value;
    }

private:
    std::size_t index(std::uint32_t mirror, int cube_face, std::uint32_t x, std::uint32_t y) const {
        return ((std::size_t{6} * mirror + static_cast<std::size_t>(cube_face)) * face + y) * face + x;
    }
};

/// Captures every mirror once, without shadows; the other mirrors are black.
inline Captured capture(const scene::Scene& scene, std::uint32_t face, Format distance, double range_world = 1, bool staged = false) {
    auto& [device, pipelines] = bench(staged);
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene, scene.cameras.front(), {16, 16}, 0);
    graph::Runner runner(device, pipelines);
    graph::Graph graph;
    const render::FrameInputs inputs{gpu_scene, {16, 16}, ""};
    render::CaptureOptions options;
    options.face = face;
    options.distance = distance;
    if (distance == Format::r8_unorm) options.stored_unit = gpu_scene.space().length(range_world);
    const render::Cubes cubes = render::declare_cubes(graph, inputs, options);
    render::add_captures(graph, inputs, options, cubes);
    graph.want(cubes.colour);
    graph.want(*cubes.distance);
    run(runner, graph);
    return {face, runner.read(cubes.colour), runner.read(*cubes.distance), gpu_scene.space()};
}

} // namespace test
