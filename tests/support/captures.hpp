#pragma once

#include "render/captured.hpp"
#include "scene/default_camera.hpp"
#include "support/device.hpp"
#include "support/scenes.hpp"
#include "support/techniques.hpp"

#include <optional>
#include <ostream>
#include <utility>

namespace catoptric {

/// Prints a format as a parameter of a test.
inline void PrintTo(TexelFormat format, std::ostream* out) { *out << format_name(format); }

} // namespace catoptric

/// Functions that render captures and read them back as numbers.
namespace test {

using render::CapturedCubes;

/// A capture that was read back, with its second depth layer if that was requested.
struct CapturedLayers {
    CapturedCubes first;
    std::optional<CapturedCubes>
        second; ///< second depth layer; only with CaptureOptions::second_layer
};

/// Captures every mirror once, without shadows and with all other mirrors black. `range_world`: the
/// range of r8_unorm distances, in world units. `staged`: see get_test_device().
inline CapturedLayers draw_cube_captures_with_options(const scene::Scene& scene,
                                                      render::CaptureOptions options,
                                                      double range_world, bool staged = false) {
    auto& [device, pipelines] = get_test_device(staged);
    render::GpuScene gpu_scene(device, scene);
    gpu_scene.update(scene,
                     scene.cameras.empty() ? scene::default_camera(scene) : scene.cameras.front(),
                     {16, 16}, 0);
    graph::GraphRunner runner(device, pipelines);
    graph::Graph graph;
    render::FrameRequests requests(gpu_scene.next_view());
    const render::FrameInputs inputs{gpu_scene, requests, {16, 16}, ""};
    if (options.distance == TexelFormat::r8_unorm)
        options.stored_unit = gpu_scene.scene_units().to_scene_length(range_world);
    const render::CubeCaptureArray cubes = add_black_captures(graph, inputs, options);
    for (const std::optional<graph::ImageHandle>& image :
         {std::optional(cubes.colour), cubes.distance, cubes.colour2, cubes.distance2})
        if (image) graph.output(*image);
    gpu_scene.fulfil(requests, [] {});
    run_graph(runner, graph);
    const auto read = [&](graph::ImageHandle colour, graph::ImageHandle distance) {
        return CapturedCubes{options.face, runner.read_back(colour), runner.read_back(distance),
                             gpu_scene.scene_units()};
    };
    CapturedLayers layers{read(cubes.colour, *cubes.distance), {}};
    if (options.second_layer) layers.second = read(*cubes.colour2, *cubes.distance2);
    return layers;
}

inline CapturedCubes capture_mirrors(const scene::Scene& scene, std::uint32_t face,
                                     TexelFormat distance, double range_world = 1,
                                     bool staged = false) {
    render::CaptureOptions options;
    options.face = face, options.distance = distance;
    return draw_cube_captures_with_options(scene, options, range_world, staged).first;
}

/// Captures both depth layers. Distances as r8_unorm range over 10 world units.
inline std::pair<CapturedCubes, CapturedCubes>
capture_both_depth_layers(const scene::Scene& scene, std::uint32_t face, TexelFormat distance) {
    render::CaptureOptions options;
    options.face = face, options.distance = distance, options.second_layer = true;
    CapturedLayers layers = draw_cube_captures_with_options(scene, options, 10);
    return {std::move(layers.first), std::move(*layers.second)};
}

} // namespace test
