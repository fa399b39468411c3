#pragma once

#include "render/captured.hpp"
#include "support/device.hpp"
#include "support/scenes.hpp"
#include "support/techniques.hpp"

#include <ostream>
#include <utility>

namespace catoptric {

/// How a test's parameter is shown.
inline void PrintTo(Format format, std::ostream* out) { *out << name_of(format); }

} // namespace catoptric

/// Cube captures as numbers.
namespace test {

using render::Captured;

/// Captures every mirror once, without shadows; the other mirrors are black. `range_world`: of
/// r8_unorm.
inline Captured capture(const scene::Scene& scene, std::uint32_t face, Format distance,
                        double range_world = 1, bool staged = false) {
    auto& [device, pipelines] = bench(staged);
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene,
                     scene.cameras.empty() ? scene::default_camera(scene) : scene.cameras.front(),
                     {16, 16}, 0);
    graph::Runner runner(device, pipelines);
    graph::Graph graph;
    const render::FrameInputs inputs{gpu_scene, {16, 16}, ""};
    render::CaptureOptions options;
    options.face = face;
    options.distance = distance;
    if (distance == Format::r8_unorm) options.stored_unit = gpu_scene.space().length(range_world);
    const render::Cubes cubes = add_black_captures(graph, inputs, options);
    graph.want(cubes.colour);
    graph.want(*cubes.distance);
    run(runner, graph);
    return {face, runner.read(cubes.colour), runner.read(*cubes.distance), gpu_scene.space()};
}

/// Both layers around every mirror, without shadows; other mirrors are black. Eight bits range over
/// 10 world units.
inline std::pair<Captured, Captured> capture_layers(const scene::Scene& scene, std::uint32_t face,
                                                    Format distance) {
    auto& [device, pipelines] = bench();
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene, scene.cameras.front(), {16, 16}, 0);
    graph::Runner runner(device, pipelines);
    graph::Graph graph;
    const render::FrameInputs inputs{gpu_scene, {16, 16}, ""};
    render::CaptureOptions options;
    options.face = face;
    options.distance = distance;
    options.second_layer = true;
    if (distance == Format::r8_unorm) options.stored_unit = gpu_scene.space().length(10);
    const render::Cubes cubes = add_black_captures(graph, inputs, options);
    for (const graph::Image image :
         {cubes.colour, *cubes.distance, *cubes.colour2, *cubes.distance2})
        graph.want(image);
    run(runner, graph);
    return {{face, runner.read(cubes.colour), runner.read(*cubes.distance), gpu_scene.space()},
            {face, runner.read(*cubes.colour2), runner.read(*cubes.distance2), gpu_scene.space()}};
}

} // namespace test
