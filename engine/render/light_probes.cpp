#include "render/light_probes.hpp"

#include "core/half.hpp"
#include "render/ambient_occlusion.hpp"
#include "render/draw.hpp"
#include "render/pass_faces.hpp"
#include "render/shown_faces.hpp"
#include "render/sky.hpp"
#include "render/views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::render {

namespace {

using graph::ImageHandle;
using graph::ResourceUse;

/// Edge of a face of the irradiance of a probe, in texels. The irradiance is a polynomial of degree
/// 2 in the normal, so few texels hold it.
constexpr std::uint32_t kIrradianceFace = 8;

std::size_t count_probes(const uvec3& counts) {
    return std::size_t{counts.x} * counts.y * counts.z;
}

/// Returns whether captures of light probes show the object. They leave out glass, which would hide
/// surfaces that light reaches through the glass.
bool is_shown_by_probes(const DrawRange& range) { return !range.glass; }

/// Returns whether the object is a lamp, whose emission is left out, because lamps already light
/// surfaces as points. Other surfaces with a texture of emission light surfaces only through light
/// probes.
bool is_lamp(const DrawRange& range) { return !range.casts_shadow && !range.glass; }

void record_probe_capture(graph::PassCommands& commands, const GpuScene& scene,
                          const DrawSettings& drawing, bool shows_surfaces) {
    const auto is_wanted = [&](std::size_t object) {
        return is_shown_by_probes(scene.draw_ranges()[object]);
    };
    const std::vector<std::uint8_t> shown = find_shown_faces(
        std::span(scene.list_views()).subspan(drawing.first_view, drawing.layers),
        {shared::kLightProbeFace, scene.device().limits().subPixelPrecisionBits},
        scene.draw_ranges(), {}, is_wanted);
    const auto is_shown = [&](std::size_t object) { return shown[object] != 0; };
    const auto is_shown_lamp = [&](std::size_t object) {
        return is_shown(object) && is_lamp(scene.draw_ranges()[object]);
    };
    const auto is_other = [&](std::size_t object) {
        return is_shown(object) && !is_lamp(scene.draw_ranges()[object]);
    };
    DrawSettings of_lamps = drawing;
    of_lamps.store.emplace_back("leaves_out_emission", 1u);
    draw_scene(commands, scene, drawing, is_other, shown);
    draw_scene(commands, scene, of_lamps, is_shown_lamp, shown);
    gpu::ShaderConstants of_sky = drawing.store;
    of_sky.emplace_back("blurs_sky", 1u);
    draw_sky(commands, scene, drawing.first_view, drawing.layers, of_sky);
    if (!shows_surfaces) return;
    // Few lamps are blended, so they may cover blended surfaces in front of them.
    draw_blended_surfaces(commands, scene, drawing, is_other, shown);
    draw_blended_surfaces(commands, scene, of_lamps, is_shown_lamp, shown);
}

/// `probe` counts from 0.
void add_probe_capture(graph::Graph& graph, const FrameInputs& inputs, const LightProbes& probes,
                       std::uint32_t probe, const ShadingLights& lighting,
                       const std::shared_ptr<const MirrorShaders>& looks) {
    const uvec3 counts = probes.grid.counts,
                place(probe % counts.x, probe / counts.x % counts.y, probe / (counts.x * counts.y));
    std::uint32_t first_view = 0;
    const std::vector<shared::View> views = make_cube_views(
        probes.grid.first + vec3(place) * probes.grid.step, 0);
    for (std::uint32_t face = 0; face < views.size(); ++face) {
        const std::uint32_t view = inputs.requests.add_view(views[face]);
        if (face == 0) first_view = view;
    }
    const std::string name = inputs.prefix + "probes/" + std::to_string(probe + 1);
    const ImageHandle depth = graph.add_image({name + ".depth", TexelFormat::d32f,
                                               shared::kLightProbeFace, shared::kLightProbeFace, 6,
                                               true});
    // The pass does not count as a scene pass, because R of the seed report counts passes by
    // mirrors and lights only (Technique::scene_passes).
    graph::PassBuilder pass = graph.add_pass(name);
    declare_shader_reads(pass, lighting, *looks);
    const float nothing = std::numeric_limits<float>::infinity();
    pass.writes(probes.colours.layers(6 * probe, 6), ResourceUse::colour, kClearBlack)
        .writes(probes.depths.layers(6 * probe, 6), ResourceUse::colour,
                graph::ClearValue{nothing, 0, 0, 0})
        .writes(depth, ResourceUse::depth, kClearFarthest)
        .layers(6)
        .record([&scene = inputs.scene,
                 shows_surfaces = probes.images.content == shared::kLightProbesOfSurfaces,
                 drawing = DrawSettings{
                     .first_view = first_view,
                     .layers = 6,
                     .lighting = lighting,
                     .looks = looks,
                     .store = {{"distance_scale", 1.0f}, {"largest_colour", kMaxHalf}},
                     .peeled = {}}](graph::PassCommands& commands) {
            record_probe_capture(commands, scene, drawing, shows_surfaces);
        });
}

} // namespace

shared::LightProbeGrid make_probe_grid(const Bounds<float>& bounds, std::size_t most,
                                       bool is_open) {
    constexpr std::uint32_t kMostAlongAnAxis = 64;
    const vec3 extent = bounds.empty() ? vec3(1) : bounds.extent(),
               centre = bounds.empty() ? vec3(0) : bounds.centre();
    const float longest = std::max({extent.x, extent.y, extent.z, 1e-6f});
    const std::uint32_t fewest_inside = is_open ? 1 : 2, outside = is_open ? 2 : 0;
    shared::LightProbeGrid grid{};
    for (std::uint32_t along = kMostAlongAnAxis;; --along) {
        const float step = longest / static_cast<float>(along);
        for (int axis = 0; axis < 3; ++axis) {
            const auto inside = std::max(
                fewest_inside, static_cast<std::uint32_t>(std::lround(extent[axis] / step)));
            grid.counts[axis] = inside + outside;
            grid.step[axis] = std::max(extent[axis], step) / static_cast<float>(inside);
            grid.first[axis] = centre[axis] -
                               .5f * grid.step[axis] * static_cast<float>(grid.counts[axis] - 1);
        }
        if (along == fewest_inside || count_probes(grid.counts) <= most) return grid;
    }
}

LightProbes declare_light_probes(graph::Graph& graph, const FrameInputs& inputs, std::uint32_t most,
                                 std::uint32_t content) {
    Bounds<float> bounds;
    for (const DrawRange& range : inputs.scene.draw_ranges()) bounds.add(range.bounds);
    LightProbes probes;
    probes.images.content = content;
    const std::size_t limit = inputs.scene.max_cubes();
    probes.grid = make_probe_grid(bounds, std::min<std::size_t>(most, limit),
                                  inputs.scene.has_sky());
    const auto image = [&](const char* what, TexelFormat format, std::uint32_t edge) {
        return graph.add_image(
            {inputs.prefix + "probes." + what, format, edge, edge, 6 * probes.count(), true});
    };
    probes.colours = image("colour", TexelFormat::rgba16f, shared::kLightProbeFace);
    probes.depths = image("depth", TexelFormat::r32f, shared::kLightProbeFace);
    probes.images.distances = image("distances", TexelFormat::rgba16f, shared::kLightProbeFace);
    probes.images.light = image("light", TexelFormat::rgba16f, kIrradianceFace);
    probes.images.grid = graph.add_image(
        {inputs.prefix + "probes.grid", TexelFormat::rgba32f, 3, 1});
    if (most > limit)
        probes.note = "of " + std::to_string(most) + " light probes, at most " +
                      std::to_string(limit) + " fit into an array of captures of this device";
    return probes;
}

void add_light_probes(graph::Graph& graph, const FrameInputs& inputs, const LightProbes& probes,
                      ShadingLights lighting, MirrorShaders looks) {
    const LightProbeImages& now = probes.images;
    if (now.content == shared::kLightProbesOfEnvironment) {
        lighting = {};
        looks = use_same_shader(inputs.scene, {});
    } else {
        lighting.probes = LightProbeImages{graph.previous(now.grid), graph.previous(now.light),
                                           graph.previous(now.distances)};
    }
    const auto shared_looks = std::make_shared<const MirrorShaders>(std::move(looks));
    for (std::uint32_t probe = 0; probe < probes.count(); ++probe)
        add_probe_capture(graph, inputs, probes, probe, lighting, shared_looks);
    graph.add_pass(inputs.prefix + "probes/light")
        .reads(probes.colours, ResourceUse::sampled)
        .reads(probes.depths, ResourceUse::sampled)
        .writes(probes.images.grid, ResourceUse::storage_write)
        .writes(probes.images.light, ResourceUse::storage_write)
        .writes(probes.images.distances, ResourceUse::storage_write)
        .record([probes, radius = inputs.scene.scene_units().to_scene_length(
                             occlusion_radius(inputs.scene))](graph::PassCommands& commands) {
            commands.bind("captured", probes.colours);
            commands.bind("captured_distances", probes.depths);
            commands.bind("grid_texels", probes.images.grid);
            commands.bind("light", probes.images.light);
            commands.bind("distances", probes.images.distances);
            commands.bind_pipeline(gpu::ComputeState{
                "probes/light.comp", {{"light_probe_content", probes.images.content}}});
            const struct {
                shared::LightProbeGrid grid;
                float radius;
            } pushed{probes.grid, radius};
            commands.push_constants(pushed);
            commands.dispatch(probes.count(), 1);
        });
}

} // namespace catoptric::render
