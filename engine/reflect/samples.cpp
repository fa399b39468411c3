#include "reflect/samples.hpp"

#include "core/content_hash.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

namespace catoptric::reflect {

namespace {

using graph::ResourceUse;

constexpr std::uint32_t kMaxSharingWorkGroups = shared::kMaxPathStarts / kPixelsPerWorkGroup;
/// Most rays to the environment from one surface of a path, because the software driver limits the
/// loops of a dispatch.
constexpr std::uint32_t kMaxEnvironmentRaysPerPath = 4;

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

/// Returns the seed of the lobes' directions. It depends on the number of rays, so that a row with
/// few rays shares no ray with a reference of many.
std::uint32_t make_lobe_seed(const TracerSettings& tracer, std::uint64_t seed) {
    ContentHash hash;
    hash.add(seed).add(tracer.rays).add(tracer.samples);
    if (tracer.seed != 0) hash.add(tracer.seed);
    if (tracer.paths) hash.add(tracer.paths);
    const std::uint64_t mixed = hash.sum();
    return static_cast<std::uint32_t>(mixed ^ mixed >> 32);
}

/// Returns the number of paths of a camera ray. Each has a direction of its own where something is
/// drawn at random.
std::uint32_t count_paths(const TracerSettings& tracer, const render::GpuScene& scene) {
    const EnvironmentRaySchedule environment = schedule_environment_rays(tracer, scene);
    const bool is_random = environment.rays > 0 || tracer.paths || scene.has_lobes_or_coats();
    return is_random ? std::max(tracer.rays, 1u) * environment.paths : 1;
}

/// Returns the number of work groups for this many pixels, or starts of paths.
std::uint32_t count_groups(std::uint32_t pixels) {
    return (pixels + kPixelsPerWorkGroup - 1) / kPixelsPerWorkGroup;
}

void bind_path_starts(graph::PassCommands& commands, const PathStarts& buffers) {
    commands.bind("Starts", buffers.starts);
    commands.bind("StartList", buffers.list);
    commands.bind("StartArguments", buffers.arguments);
}

/// The dispatches of a pass that traces samples of pixels.
struct SampleTracing {
    graph::PassCommands& commands;
    gpu::ComputeState state;
    std::vector<vec2> offsets; ///< of the samples, each of which has a camera ray
    std::uint32_t groups = 0;  ///< of pixels; with `arguments`, the most
    /// Counts of work groups that only the device knows. The frame is then in one piece.
    std::optional<graph::BufferHandle> arguments;
    bool is_split = false;              ///< whether the frame may be in pieces
    shared::TraceParameters parameters; ///< of the next dispatch
    bool is_first = true;

    void wait_for_last() {
        if (!std::exchange(is_first, false)) commands.storage_barrier();
    }

    void dispatch_pixels(std::uint32_t first, std::uint32_t count) {
        wait_for_last();
        if (!arguments) return dispatch_groups(commands, first, count, parameters);
        commands.add_rays(std::uint64_t{count} * kPixelsPerWorkGroup);
        parameters.first_group = 0;
        commands.push_constants(parameters);
        commands.dispatch_indirect(*arguments);
    }

    /// Traces each path with a camera ray of its own.
    void trace_whole_paths() {
        const auto paths = static_cast<std::uint32_t>(parameters.sample_count / offsets.size());
        commands.bind_pipeline(state);
        for (; parameters.sample_index < parameters.sample_count; ++parameters.sample_index) {
            parameters.sample_offset = offsets[parameters.sample_index / paths];
            dispatch_pixels(0, groups);
        }
    }

    /// Traces one path from each start that the last dispatch has listed, for each path of a camera
    /// ray. `most`: most work groups of starts.
    void resume_paths(const PathStarts& starts, std::uint32_t most) {
        std::uint32_t count = 0;
        if (is_split)
            count = count_groups(
                commands.read_word(starts.arguments, offsetof(shared::PathStartArguments, count)));
        else
            commands.add_rays(std::uint64_t{most} * kPixelsPerWorkGroup * parameters.path_count);
        gpu::ComputeState resuming = state;
        resuming.constants.emplace_back("resumes_paths", 1u);
        commands.bind_pipeline(resuming);
        parameters.first_group = 0;
        for (std::uint32_t i = 0; i < parameters.path_count; ++i, ++parameters.sample_index) {
            wait_for_last();
            if (is_split) {
                dispatch_groups(commands, 0, count, parameters);
            } else {
                commands.push_constants(parameters);
                commands.dispatch_indirect(starts.arguments);
            }
        }
    }

    /// Traces the camera rays of each sample, and then the paths of these rays.
    void trace_shared_paths(const PathStarts& starts) {
        bind_path_starts(commands, starts);
        parameters.path_count = static_cast<std::uint32_t>(parameters.sample_count /
                                                           offsets.size());
        for (std::uint32_t first = 0; first < groups; first += kMaxSharingWorkGroups) {
            const std::uint32_t count = std::min(groups - first, kMaxSharingWorkGroups);
            parameters.sample_index = 0;
            for (const vec2& offset : offsets) {
                parameters.sample_offset = offset;
                commands.bind_pipeline(state);
                dispatch_pixels(first, count);
                wait_for_last();
                commands.bind_pipeline(gpu::ComputeState{"starts_list.comp"});
                if (arguments)
                    commands.dispatch_indirect(*arguments);
                else
                    commands.dispatch(count, 1);
                resume_paths(starts, count);
            }
        }
    }
};

} // namespace

/// Light probes and paths find the environment's light themselves.
EnvironmentRaySchedule schedule_environment_rays(const TracerSettings& tracer,
                                                 const render::GpuScene& scene) {
    const std::uint32_t wanted = scene.environment_shadow_rays(), rays = std::max(tracer.rays, 1u);
    if (wanted == 0 || tracer.paths || tracer.lighting.probes ||
        tracer.shadow == TracerSettings::Shadow::none)
        return {};
    const auto divide_and_round_up = [](std::uint32_t a, std::uint32_t b) {
        return (a + b - 1) / b;
    };
    const std::uint32_t paths = divide_and_round_up(wanted, rays * kMaxEnvironmentRaysPerPath);
    return {paths, divide_and_round_up(wanted, rays * paths)};
}

std::uint64_t most_rays(const TracerSettings& tracer, const render::GpuScene& scene, uvec2 size) {
    const std::uint32_t paths = count_paths(tracer, scene);
    return std::uint64_t{size.x} * size.y * static_cast<std::uint32_t>(tracer.samples) *
           (paths == 1 ? 1 : 1 + paths);
}

std::uint32_t picture_groups(uvec2 size) { return (size.x + 7) / 8 * ((size.y + 7) / 8); }

std::optional<PathStarts> add_path_starts(graph::Graph& graph, const render::FrameInputs& inputs,
                                          const TracerSettings& tracer, const std::string& suffix) {
    // Points in double precision depend on rays that the starts do not hold. Where a raster pass
    // draws the first surfaces, paths share too little to pay for two more dispatches.
    if (tracer.doubles || tracer.first_raster || count_paths(tracer, inputs.scene) == 1) return {};
    const std::string name = inputs.prefix + "starts" + suffix;
    const std::uint64_t count = std::min(picture_groups(inputs.size) * kPixelsPerWorkGroup,
                                         shared::kMaxPathStarts);
    const PathStarts buffers{
        graph.add_buffer({name, count * sizeof(shared::PathStart)}),
        graph.add_buffer({name + "/list", count * sizeof(std::uint32_t)}),
        graph.add_buffer({name + "/arguments", sizeof(shared::PathStartArguments)})};
    graph.add_pass(name + "/reset")
        .writes(buffers.arguments, ResourceUse::copy_to)
        .record([=](graph::PassCommands& commands) { commands.fill_buffer(buffers.arguments, 0); });
    return buffers;
}

void declare_path_starts(graph::PassBuilder& pass, const PathStarts& buffers) {
    pass.writes(buffers.starts, ResourceUse::storage_write)
        .writes(buffers.list, ResourceUse::storage_write)
        .writes(buffers.arguments, ResourceUse::storage);
}

void trace_samples(graph::PassCommands& commands, gpu::ComputeState state,
                   const TracerSettings& tracer, const render::FrameInputs& inputs,
                   const TraceList* list, const std::optional<PathStarts>& starts) {
    SampleTracing tracing{.commands = commands,
                          .state = std::move(state),
                          .offsets = make_sample_offsets(tracer.samples, inputs.facts.seed),
                          .groups = picture_groups(inputs.size),
                          .is_split = most_rays(tracer, inputs.scene, inputs.size) >
                                      commands.rays_per_piece(),
                          .parameters = {.size = inputs.size,
                                         .seed = make_lobe_seed(tracer, inputs.facts.seed),
                                         .path_count = 1}};
    tracing.parameters.sample_count = static_cast<std::uint32_t>(tracing.offsets.size()) *
                                      count_paths(tracer, inputs.scene);
    // The host learns the number of listed pixels only if it must divide them.
    const bool is_divided = starts && tracing.groups > kMaxSharingWorkGroups;
    if (list && (tracing.is_split || is_divided))
        tracing.groups = count_groups(
            commands.read_word(list->counters, offsetof(shared::Counters, listed)));
    else if (list)
        tracing.arguments = list->arguments;
    if (starts)
        tracing.trace_shared_paths(*starts);
    else
        tracing.trace_whole_paths();
}

} // namespace catoptric::reflect
