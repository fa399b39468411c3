// Whitted ray tracing in a compute shader, over a BVH that needs no ray-tracing extension.
#include "reflect/tracer.hpp"

#include "reflect/samples.hpp"
#include "render/draw.hpp"

#include <optional>

namespace catoptric::reflect {

namespace {

using graph::ResourceUse;

/// Offset of a ray's origin in the seed report, in world units.
constexpr double kSeedRayOffset = 1e-3;

render::SphereMode sphere_mode(const TracerSettings& tracer) {
    return tracer.exact_spheres ? render::SphereMode::exact : render::SphereMode::mesh;
}

/// Returns whether rays may aim at lamps. Exact spheres and points in double precision differ from
/// the triangles on which points are drawn.
bool may_sample_lamps(const TracerSettings& tracer) {
    return tracer.samples_lamps && tracer.rays > 0 && !tracer.exact_spheres && !tracer.doubles;
}

/// Asks for what a tracing pass reads of the scene.
void request_tracing(render::FrameRequests& requests, const TracerSettings& tracer) {
    requests.trace_rays(sphere_mode(tracer), tracer.first_raster);
    if (may_sample_lamps(tracer)) requests.sample_lamps();
}

bool reads_shadow_map(const TracerSettings& tracer) {
    return tracer.shadow != TracerSettings::Shadow::none && tracer.lighting.shadow_map;
}

/// Declares the pass that sets a tracer's counters to 0. `pass`: name of the tracing pass.
graph::BufferHandle add_counters(graph::Graph& graph, std::string name, const std::string& pass) {
    const graph::BufferHandle counters = graph.add_buffer(
        {std::move(name), sizeof(shared::Counters)});
    graph.add_pass(pass + "/reset")
        .writes(counters, ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) { commands.fill_buffer(counters, 0); });
    return counters;
}

/// Returns whether the tracer completes pixels of a view in which near surfaces hide light
/// (render/ambient_occlusion.hpp).
bool reads_ambient_occlusion(const TracerSettings& tracer, bool listed) {
    return listed && tracer.lighting.ambient_occlusion;
}

gpu::ComputeState make_tracer_state(const TracerSettings& tracer, const render::GpuScene& scene,
                                    bool listed, bool shares_camera_rays) {
    std::string build;
    for (const auto& [wanted, name] :
         {std::pair{listed, "listed"}, std::pair{tracer.doubles, "doubles"},
          std::pair{shares_camera_rays, "shared"}})
        if (wanted) build += (build.empty() ? "#" : "_") + std::string(name);
    gpu::ComputeState state{
        "raytrace.comp" + build,
        {{"max_depth", tracer.depth},
         {"shadow", static_cast<std::uint32_t>(tracer.shadow)},
         {"has_shadow_map", reads_shadow_map(tracer) ? 1u : 0u},
         {"light_probe_content", tracer.lighting.probes ? tracer.lighting.probes->content : 0u},
         {"exact_spheres", tracer.exact_spheres ? 1u : 0u},
         {"first_raster", tracer.first_raster ? 1u : 0u},
         {"traces_lobes", tracer.rays > 0 ? 1u : 0u},
         {"samples_lamps", may_sample_lamps(tracer) && scene.has_sampled_lamps() ? 1u : 0u},
         {"traces_paths", tracer.paths ? 1u : 0u},
         {"environment_shadows", schedule_environment_rays(tracer, scene).rays},
         {"without", tracer.without},
         {"fixed_offset", scene.scene_units().to_scene_length(kSeedRayOffset)}},
        scene.tracing_constants(sphere_mode(tracer))};
    if (reads_ambient_occlusion(tracer, listed))
        state.constants.emplace_back("has_ambient_occlusion", 1u);
    return state;
}

void bind_tracer(graph::PassCommands& commands, const render::GpuScene& scene,
                 const TracerSettings& tracer) {
    scene.bind(commands);
    scene.bind_tracing(commands, sphere_mode(tracer));
    render::ShadingLights read = tracer.lighting;
    if (!reads_shadow_map(tracer)) read.shadow_map.reset();
    render::bind_lighting(commands, read);
}

/// Declares the reads of the images that bind_tracer binds.
void declare_lighting_reads(graph::PassBuilder& pass, const TracerSettings& tracer) {
    render::ShadingLights read = tracer.lighting;
    if (!reads_shadow_map(tracer)) read.shadow_map.reset();
    render::declare_shader_reads(pass, read, {});
}

TraceList add_list_pass(graph::Graph& graph, const render::FrameInputs& inputs,
                        const std::string& suffix, std::uint32_t number, bool first_raster,
                        const render::CameraOutputs& view) {
    const uvec2 size = inputs.size;
    const std::string name = inputs.prefix + "list" + suffix;
    TraceList list;
    // shaders/lib/trace_list.glsl describes the words of an entry.
    const std::uint32_t words = first_raster ? 3 : 1;
    list.pixels = graph.add_buffer({name, words * sizeof(std::uint32_t) * size.x * size.y});
    list.arguments = graph.add_buffer({name + "/arguments", 3 * sizeof(std::uint32_t)});
    list.counters = graph.add_buffer(
        {inputs.prefix + "counters" + suffix, sizeof(shared::Counters)});
    graph.add_pass(name + "/reset")
        .writes(list.counters, ResourceUse::copy_to)
        .writes(list.arguments, ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) {
            commands.fill_buffer(list.counters, 0);
            commands.fill_buffer(list.arguments, 0);
        });
    const bool in_alpha = !view.tracers; // see render::add_camera_view
    graph::PassBuilder pass = graph.add_pass(name);
    if (in_alpha || first_raster) pass.reads(view.hdr, ResourceUse::storage_read);
    if (!in_alpha)
        pass.reads(*view.lookup, ResourceUse::storage_read)
            .reads(*view.tracers, ResourceUse::storage_read);
    pass.writes(list.counters, ResourceUse::storage)
        .writes(list.arguments, ResourceUse::storage)
        .writes(list.pixels, ResourceUse::storage_write)
        .record([=](graph::PassCommands& commands) {
            if (in_alpha || first_raster) commands.bind("picture", view.hdr);
            if (!in_alpha) {
                commands.bind("lookup", *view.lookup);
                commands.bind("marks", *view.tracers);
            }
            commands.bind("counters", list.counters);
            commands.bind("arguments", list.arguments);
            commands.bind("List", list.pixels);
            const char* const shader = in_alpha ? "trace_list.comp#first" : "trace_list.comp";
            commands.bind_pipeline(gpu::ComputeState{
                shader, {{"tracer", number}, {"first_raster", first_raster ? 1u : 0u}}});
            commands.push_constants(size);
            commands.dispatch((size.x + 7) / 8, (size.y + 7) / 8);
        });
    return list;
}

} // namespace

TracedPicture add_picture_tracing(graph::Graph& graph, const render::FrameInputs& inputs,
                                  const TracerSettings& tracer) {
    const uvec2 size = inputs.size;
    const TracedPicture traced{
        graph.add_image({inputs.prefix + "hdr", TexelFormat::rgba32f, size.x, size.y}),
        add_counters(graph, inputs.prefix + "counters", inputs.prefix + "raytrace")};
    request_tracing(inputs.requests, tracer);
    const std::optional<PathStarts> starts = add_path_starts(graph, inputs, tracer, "");
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + "raytrace");
    declare_lighting_reads(pass, tracer);
    if (starts) declare_path_starts(pass, *starts);
    pass.writes(traced.hdr, ResourceUse::storage_write)
        .writes(traced.counters, ResourceUse::storage)
        .most_rays(most_rays(tracer, inputs.scene, size))
        .record([=, &scene = inputs.scene](graph::PassCommands& commands) {
            bind_tracer(commands, scene, tracer);
            commands.bind("picture", traced.hdr);
            commands.bind("counters", traced.counters);
            trace_samples(commands, make_tracer_state(tracer, scene, false, starts.has_value()),
                          tracer, inputs, nullptr, starts);
        });
    return traced;
}

FirstSurfaceImages add_first_surface(graph::Graph& graph, const render::FrameInputs& inputs) {
    const uvec2 size = inputs.size;
    const auto add_image = [&](const char* name) {
        return graph.add_image({inputs.prefix + name, TexelFormat::rgba32f, size.x, size.y});
    };
    const FirstSurfaceImages images{add_image("normals_and_distances"),
                                    add_image("objects_and_roughness"),
                                    add_counters(graph, inputs.prefix + "first_surface/counters",
                                                 inputs.prefix + "first_surface")};
    const TracerSettings tracer;
    request_tracing(inputs.requests, tracer);
    graph.add_pass(inputs.prefix + "first_surface")
        .writes(images.normals_and_distances, ResourceUse::storage_write)
        .writes(images.objects_and_roughness, ResourceUse::storage_write)
        .writes(images.counters, ResourceUse::storage)
        .most_rays(std::uint64_t{size.x} * size.y)
        .record([=, &scene = inputs.scene](graph::PassCommands& commands) {
            bind_tracer(commands, scene, tracer);
            commands.bind("normals_and_distances", images.normals_and_distances);
            commands.bind("objects_and_roughness", images.objects_and_roughness);
            commands.bind("counters", images.counters);
            commands.bind_pipeline(gpu::ComputeState{
                "first_surface.comp", {}, scene.tracing_constants(sphere_mode(tracer))});
            struct {
                uvec2 size;
                std::uint32_t first_group;
            } parameters{size, 0};
            dispatch_groups(commands, 0, picture_groups(size), parameters);
        });
    return images;
}

graph::BufferHandle add_list_tracing(graph::Graph& graph, const render::FrameInputs& inputs,
                                     const TracerSettings& tracer, std::uint32_t number,
                                     const render::CameraOutputs& view) {
    const std::string suffix = number == 1 ? "" : std::to_string(number);
    const TraceList list = add_list_pass(graph, inputs, suffix, number, tracer.first_raster, view);
    request_tracing(inputs.requests, tracer);
    const std::optional<PathStarts> starts = add_path_starts(graph, inputs, tracer, suffix);
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + "trace" + suffix);
    declare_lighting_reads(pass, tracer);
    if (starts) declare_path_starts(pass, *starts);
    pass.reads(list.arguments, ResourceUse::indirect)
        .reads(list.pixels, ResourceUse::storage_read)
        .writes(list.counters, ResourceUse::storage)
        .writes(view.hdr, ResourceUse::storage)
        .most_rays(most_rays(tracer, inputs.scene, inputs.size))
        .record([=, &scene = inputs.scene, hdr = view.hdr](graph::PassCommands& commands) {
            bind_tracer(commands, scene, tracer);
            commands.bind("picture", hdr);
            commands.bind("counters", list.counters);
            commands.bind("List", list.pixels);
            trace_samples(commands, make_tracer_state(tracer, scene, true, starts.has_value()),
                          tracer, inputs, &list, starts);
        });
    return list.counters;
}

} // namespace catoptric::reflect
