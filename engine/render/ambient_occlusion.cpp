#include "render/ambient_occlusion.hpp"

#include "render/draw.hpp"
#include "render/pass_faces.hpp"

namespace catoptric::render {

using graph::ImageHandle;
using graph::PassCommands;
using graph::ResourceUse;

namespace {

/// Draws the surfaces of which ambient occlusion is computed (shaders/occlusion/surface.frag).
ImageHandle add_surface_pass(graph::Graph& graph, const FrameInputs& inputs) {
    const uvec2 size = inputs.size;
    const ImageHandle surfaces = graph.add_image(
        {inputs.prefix + "occlusion.surfaces", TexelFormat::rgba32f, size.x, size.y});
    const ImageHandle depth = graph.add_image(
        {inputs.prefix + "occlusion.depth", TexelFormat::d32f, size.x, size.y});
    graph.add_pass(inputs.prefix + "occlusion/surfaces")
        .writes(surfaces, ResourceUse::colour, graph::ClearValue{})
        .writes(depth, ResourceUse::depth, kClearFarthest)
        .record([&scene = inputs.scene](PassCommands& commands) {
            scene.bind(commands);
            draw_without_back_faces(commands, scene, {"", "occlusion/surface.frag", {}},
                                    GpuScene::kCameraViewIndex, 1, {}, [&](std::size_t object) {
                                        const DrawRange& range = scene.draw_ranges()[object];
                                        return range.seen_by_camera && !range.glass;
                                    });
        });
    return surfaces;
}

} // namespace

double occlusion_radius(const GpuScene& scene) {
    constexpr double kPartOfDiagonal = .125;
    const SceneUnits& units = scene.scene_units();
    return units.core.empty() ? 0
                              : kPartOfDiagonal * length(dvec3(units.core.extent())) / units.scale;
}

ImageHandle add_ambient_occlusion(graph::Graph& graph, const FrameInputs& inputs) {
    const uvec2 size = inputs.size;
    const ImageHandle surfaces = add_surface_pass(graph, inputs);
    const ImageHandle solid_angles = graph.add_image(
        {inputs.prefix + "occlusion.solid_angles", TexelFormat::rgba16f, size.x, size.y});
    const ImageHandle shares = graph.add_image(
        {inputs.prefix + "occlusion", TexelFormat::r32f, size.x, size.y});
    const auto bind_and_dispatch = [&scene = inputs.scene, size](PassCommands& commands,
                                                                 const char* shader, auto&& push) {
        commands.bind_pipeline(gpu::ComputeState{shader, {}, scene.feature_constants()});
        push();
        commands.dispatch((size.x + 7) / 8, (size.y + 7) / 8);
    };
    graph.add_pass(inputs.prefix + "occlusion/share")
        .reads(surfaces, ResourceUse::sampled)
        .writes(solid_angles, ResourceUse::storage_write)
        .record([=, &scene = inputs.scene](PassCommands& commands) {
            scene.bind(commands);
            commands.bind("surfaces", surfaces);
            commands.bind("solid_angles", solid_angles);
            bind_and_dispatch(commands, "occlusion/share.comp", [&] {
                commands.push_constants(
                    scene.scene_units().to_scene_length(occlusion_radius(scene)));
            });
        });
    graph.add_pass(inputs.prefix + "occlusion/mean")
        .reads(surfaces, ResourceUse::sampled)
        .reads(solid_angles, ResourceUse::sampled)
        .writes(shares, ResourceUse::storage_write)
        .record([=, &scene = inputs.scene](PassCommands& commands) {
            scene.bind(commands);
            commands.bind("surfaces", surfaces);
            commands.bind("solid_angles", solid_angles);
            commands.bind("shares", shares);
            bind_and_dispatch(commands, "occlusion/mean.comp", [] {});
        });
    return shares;
}

} // namespace catoptric::render
