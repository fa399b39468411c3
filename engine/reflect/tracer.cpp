// Whitted ray tracing in a compute shader, over a BVH that needs no ray-tracing extension. Each
// sample is one dispatch, or several in pieces of the frame, and the picture adds the samples up.
// The reason is a software driver that ends all loops of an invocation after 65,535 iterations. One
// sample of a deep path stays below this limit.
#include "reflect/tracer.hpp"

#include "core/content_hash.hpp"
#include "render/draw.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace catoptric::reflect {

namespace {

using graph::ResourceUse;

/// Offset of a ray's origin in the seed report, in world units.
constexpr double kSeedReportRayOffset = 1e-3;
/// Pixels of a work group: 8x8 of a picture, or 64 of a list (kPixelsPerListGroup in
/// shaders/lib/trace_list.glsl).
constexpr std::uint32_t kPixelsPerWorkGroup = 64;

/// Returns the positions of the samples in the pixel. These are the centre for one sample, and a
/// regular grid for n*n. Other counts get one jittered point in each of n cells of the smallest
/// grid that holds them.
std::vector<vec2> make_sample_offsets(int count, std::uint64_t seed) {
    const int edge = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
    const bool regular = edge * edge == count;
    std::mt19937_64 random(seed);
    std::vector<vec2> offsets;
    for (int i = 0; i < count; ++i) {
        const auto jitter = [&] {
            return regular ? 0.5f : static_cast<float>(random() >> 40) * 0x1p-24f;
        };
        const float y = static_cast<float>(i / edge) + jitter(),
                    x = static_cast<float>(i % edge) + jitter();
        offsets.push_back(vec2(x, y) / static_cast<float>(edge));
    }
    return offsets;
}

/// Most rays to the environment from one surface in one dispatch, because the software driver
/// limits the loops of a dispatch.
constexpr std::uint32_t kMaxEnvironmentRaysPerDispatch = 4;

/// How the rays to the environment are spread over dispatches.
struct EnvironmentRaySchedule {
    std::uint32_t dispatches = 1; ///< for each ray of each sample
    std::uint32_t rays = 0;       ///< from one surface in one dispatch; 0: objects do not hide it
};

/// Returns a schedule with at least as many rays for each sample as the scene asks for. Light
/// probes and paths find the environment's light themselves.
EnvironmentRaySchedule schedule_environment_rays(const TracerSettings& tracer,
                                                 const render::GpuScene& scene) {
    const std::uint32_t wanted = scene.environment_shadow_rays(), rays = std::max(tracer.rays, 1u);
    if (wanted == 0 || tracer.paths || tracer.lighting.probes ||
        tracer.shadow == TracerSettings::TracedShadow::none)
        return {};
    const auto divide_and_round_up = [](std::uint32_t a, std::uint32_t b) {
        return (a + b - 1) / b;
    };
    const std::uint32_t dispatches = divide_and_round_up(wanted,
                                                         rays * kMaxEnvironmentRaysPerDispatch);
    return {dispatches, divide_and_round_up(wanted, rays * dispatches)};
}

render::SphereIntersectionMode sphere_mode_of_tracer(const TracerSettings& tracer) {
    return tracer.exact_spheres ? render::SphereIntersectionMode::exact
                                : render::SphereIntersectionMode::mesh;
}

/// Returns whether rays may aim at lamps. Exact spheres and points in double precision differ from
/// the triangles on which points are drawn.
bool may_sample_lamp_points(const TracerSettings& tracer) {
    return tracer.samples_lamps && tracer.rays > 0 && !tracer.exact_spheres && !tracer.doubles;
}

/// Announces what a tracing pass reads of the scene.
void request_ray_tracing_data(const render::GpuScene& scene, const TracerSettings& tracer) {
    scene.request_ray_tracing(sphere_mode_of_tracer(tracer), tracer.first_raster);
    if (may_sample_lamp_points(tracer)) scene.request_lamp_points();
}

bool does_ray_tracer_read_shadow_map(const TracerSettings& tracer) {
    return tracer.shadow != TracerSettings::TracedShadow::none && tracer.lighting.shadow_map;
}

/// Returns the number of work groups of 8x8 pixels.
std::uint32_t count_picture_work_groups(uvec2 size) {
    return (size.x + 7) / 8 * ((size.y + 7) / 8);
}

/// Declares the pass that sets a tracer's counters to 0.
graph::BufferHandle add_counters_with_reset(graph::Graph& graph, const std::string& prefix,
                                            const std::string& pass) {
    const graph::BufferHandle counters = graph.add_buffer(
        {prefix + "counters", sizeof(shared::Counters)});
    graph.add_pass(prefix + pass + "/reset")
        .writes(counters, ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) { commands.fill_buffer(counters, 0); });
    return counters;
}

/// Returns whether the tracer completes pixels of a view in which near surfaces hide light
/// (render/ambient_occlusion.hpp).
bool reads_ambient_occlusion(const TracerSettings& tracer, bool listed) {
    return listed && tracer.lighting.ambient_occlusion;
}

gpu::ComputePipelineState make_tracer_state(const TracerSettings& tracer,
                                            const render::GpuScene& scene, bool listed) {
    std::string build;
    for (const auto& [wanted, name] :
         {std::pair{listed, "listed"}, std::pair{tracer.doubles, "doubles"}})
        if (wanted) build += (build.empty() ? "#" : "_") + std::string(name);
    gpu::ComputePipelineState state{
        "raytrace.comp" + build,
        {{"max_depth", tracer.depth},
         {"shadow", static_cast<std::uint32_t>(tracer.shadow)},
         {"has_shadow_map", does_ray_tracer_read_shadow_map(tracer) ? 1u : 0u},
         {"light_probe_content", tracer.lighting.probes ? tracer.lighting.probes->content : 0u},
         {"exact_spheres", tracer.exact_spheres ? 1u : 0u},
         {"first_raster", tracer.first_raster ? 1u : 0u},
         {"traces_lobes", tracer.rays > 0 ? 1u : 0u},
         {"samples_lamps", may_sample_lamp_points(tracer) && scene.has_sampled_lamps() ? 1u : 0u},
         {"traces_paths", tracer.paths ? 1u : 0u},
         {"environment_shadows", schedule_environment_rays(tracer, scene).rays},
         {"without", tracer.without},
         {"fixed_offset", scene.scene_units().world_to_scene_length(kSeedReportRayOffset)}},
        scene.ray_tracing_feature_constants(sphere_mode_of_tracer(tracer))};
    if (reads_ambient_occlusion(tracer, listed))
        state.constants.emplace_back("has_ambient_occlusion", 1u);
    return state;
}

/// Binds the resources of a tracing pass.
void bind_tracer_resources(graph::PassCommands& commands, const render::GpuScene& scene,
                           const TracerSettings& tracer) {
    scene.bind(commands);
    scene.bind_ray_tracing_buffers(commands, sphere_mode_of_tracer(tracer));
    render::ShadingLights read = tracer.lighting;
    if (!does_ray_tracer_read_shadow_map(tracer)) read.shadow_map.reset();
    render::bind_lighting_images(commands, read);
}

/// Declares the reads of the images that bind_tracer_resources binds.
void declare_lighting_reads(graph::PassBuilder& pass, const TracerSettings& tracer) {
    render::ShadingLights read = tracer.lighting;
    if (!does_ray_tracer_read_shadow_map(tracer)) read.shadow_map.reset();
    render::declare_shader_reads(pass, read, {});
}

/// Returns the seed of the lobes' directions. It depends on the number of rays, so that a row with
/// few rays shares no ray with a reference of many.
std::uint32_t make_lobe_seed(const TracerSettings& tracer, std::uint64_t seed) {
    ContentHash hash;
    hash.add_value(seed).add_value(tracer.rays).add_value(tracer.samples);
    if (tracer.seed != 0) hash.add_value(tracer.seed);
    if (tracer.paths) hash.add_value(tracer.paths);
    const std::uint64_t mixed = hash.current_hash();
    return static_cast<std::uint32_t>(mixed ^ mixed >> 32);
}

/// Returns the dispatches that each pixel takes part in: one per sample and ray, or more for rays
/// to the environment.
std::uint32_t count_dispatches(const TracerSettings& tracer, const render::GpuScene& scene) {
    return static_cast<std::uint32_t>(tracer.samples) * std::max(tracer.rays, 1u) *
           schedule_environment_rays(tracer, scene).dispatches;
}

/// Returns the most rays that this tracer sends from the pixels of a picture, counting those of a
/// lobe, and one for a pixel without.
std::uint64_t count_most_rays(const TracerSettings& tracer, const render::GpuScene& scene,
                              uvec2 size) {
    return std::uint64_t{size.x} * size.y * count_dispatches(tracer, scene);
}

/// Runs all dispatches, with barriers between them. `dispatch` gets the parameters of each.
template <typename Dispatch>
void dispatch_sample_passes(graph::PassCommands& commands, const TracerSettings& tracer,
                            const render::GpuScene& scene, uvec2 size, std::uint64_t seed,
                            Dispatch&& dispatch) {
    const std::vector<vec2> offsets = make_sample_offsets(tracer.samples, seed);
    const std::uint32_t count = count_dispatches(tracer, scene),
                        rays = count / static_cast<std::uint32_t>(offsets.size());
    const std::uint32_t lobe_seed = make_lobe_seed(tracer, seed);
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i > 0) commands.storage_barrier();
        dispatch(shared::TraceParameters{offsets[i / rays], i, count, size, lobe_seed, 0});
    }
}

/// Dispatches these work groups, one invocation for each pixel, in pieces of the frame if they are
/// many. `parameters`: push constants.
template <typename Parameters>
void dispatch_work_groups(graph::PassCommands& commands, std::uint32_t groups,
                          Parameters parameters) {
    commands.split_rays(groups, kPixelsPerWorkGroup, [&](std::uint32_t first, uvec2 range) {
        parameters.first_group = first;
        commands.push_constants(parameters);
        commands.dispatch(range.x, range.y);
    });
}

/// The pixels to trace, the dispatch arguments in work groups, and counters.
struct PixelsToTraceList {
    graph::BufferHandle pixels, arguments, counters;
};

PixelsToTraceList add_pass_listing_pixels_to_trace(graph::Graph& graph,
                                                   const render::FrameInputs& inputs,
                                                   const std::string& suffix, std::uint32_t number,
                                                   bool first_raster,
                                                   const render::CameraPassOutputs& view) {
    const uvec2 size = inputs.size;
    const std::string name = inputs.prefix + "list" + suffix;
    PixelsToTraceList list;
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
            if (in_alpha || first_raster) commands.bind_resource("picture", view.hdr);
            if (!in_alpha) {
                commands.bind_resource("lookup", *view.lookup);
                commands.bind_resource("marks", *view.tracers);
            }
            commands.bind_resource("counters", list.counters);
            commands.bind_resource("arguments", list.arguments);
            commands.bind_resource("List", list.pixels);
            const char* const shader = in_alpha ? "trace_list.comp#first" : "trace_list.comp";
            commands.bind_pipeline(gpu::ComputePipelineState{
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
        add_counters_with_reset(graph, inputs.prefix, "raytrace")};
    request_ray_tracing_data(inputs.scene, tracer);
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + "raytrace");
    declare_lighting_reads(pass, tracer);
    pass.writes(traced.hdr, ResourceUse::storage_write)
        .writes(traced.counters, ResourceUse::storage)
        .most_rays(count_most_rays(tracer, inputs.scene, size))
        .record([=, &scene = inputs.scene, seed = inputs.seed](graph::PassCommands& commands) {
            bind_tracer_resources(commands, scene, tracer);
            commands.bind_resource("picture", traced.hdr);
            commands.bind_resource("counters", traced.counters);
            commands.bind_pipeline(make_tracer_state(tracer, scene, false));
            dispatch_sample_passes(commands, tracer, scene, size, seed,
                                   [&](const shared::TraceParameters& parameters) {
                                       dispatch_work_groups(
                                           commands, count_picture_work_groups(size), parameters);
                                   });
        });
    return traced;
}

FirstSurfaceImages add_first_surface_tracing(graph::Graph& graph,
                                             const render::FrameInputs& inputs) {
    const uvec2 size = inputs.size;
    const auto add_image = [&](const char* name) {
        return graph.add_image({inputs.prefix + name, TexelFormat::rgba32f, size.x, size.y});
    };
    const FirstSurfaceImages images{add_image("normals_and_distances"),
                                    add_image("objects_and_roughness"),
                                    add_counters_with_reset(graph, inputs.prefix, "first_surface")};
    const TracerSettings tracer;
    request_ray_tracing_data(inputs.scene, tracer);
    graph.add_pass(inputs.prefix + "first_surface")
        .writes(images.normals_and_distances, ResourceUse::storage_write)
        .writes(images.objects_and_roughness, ResourceUse::storage_write)
        .writes(images.counters, ResourceUse::storage)
        .most_rays(std::uint64_t{size.x} * size.y)
        .record([=, &scene = inputs.scene](graph::PassCommands& commands) {
            bind_tracer_resources(commands, scene, tracer);
            commands.bind_resource("normals_and_distances", images.normals_and_distances);
            commands.bind_resource("objects_and_roughness", images.objects_and_roughness);
            commands.bind_resource("counters", images.counters);
            commands.bind_pipeline(gpu::ComputePipelineState{
                "first_surface.comp",
                {},
                scene.ray_tracing_feature_constants(sphere_mode_of_tracer(tracer))});
            struct {
                uvec2 size;
                std::uint32_t first_group;
            } parameters{size, 0};
            dispatch_work_groups(commands, count_picture_work_groups(size), parameters);
        });
    return images;
}

graph::BufferHandle add_tracing_of_pixel_list(graph::Graph& graph,
                                              const render::FrameInputs& inputs,
                                              const TracerSettings& tracer, std::uint32_t number,
                                              const render::CameraPassOutputs& view) {
    const std::string suffix = number == 1 ? "" : std::to_string(number);
    const PixelsToTraceList list = add_pass_listing_pixels_to_trace(graph, inputs, suffix, number,
                                                                    tracer.first_raster, view);
    request_ray_tracing_data(inputs.scene, tracer);
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + "trace" + suffix);
    declare_lighting_reads(pass, tracer);
    pass.reads(list.arguments, ResourceUse::indirect)
        .reads(list.pixels, ResourceUse::storage_read)
        .writes(list.counters, ResourceUse::storage)
        .writes(view.hdr, ResourceUse::storage)
        .most_rays(count_most_rays(tracer, inputs.scene, inputs.size))
        .record([=, &scene = inputs.scene, size = inputs.size, seed = inputs.seed,
                 hdr = view.hdr](graph::PassCommands& commands) {
            bind_tracer_resources(commands, scene, tracer);
            commands.bind_resource("picture", hdr);
            commands.bind_resource("counters", list.counters);
            commands.bind_resource("List", list.pixels);
            commands.bind_pipeline(make_tracer_state(tracer, scene, true));
            // The host learns the number of listed pixels only if the frame must be in pieces.
            const std::uint64_t most = count_most_rays(tracer, scene, size);
            const bool is_split = most > commands.most_rays_of_piece();
            if (!is_split) commands.add_rays(most);
            const std::uint32_t listed = is_split ? commands.read_word(
                                                        list.counters,
                                                        offsetof(shared::Counters, listed))
                                                  : 0;
            dispatch_sample_passes(commands, tracer, scene, size, seed,
                                   [&](const shared::TraceParameters& parameters) {
                                       if (is_split) {
                                           dispatch_work_groups(commands,
                                                                (listed + kPixelsPerWorkGroup - 1) /
                                                                    kPixelsPerWorkGroup,
                                                                parameters);
                                           return;
                                       }
                                       commands.push_constants(parameters);
                                       commands.dispatch_indirect(list.arguments);
                                   });
        });
    return list.counters;
}

} // namespace catoptric::reflect
