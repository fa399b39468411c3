#pragma once

#include "gpu/stage.hpp"
#include "reflect/tracer.hpp"

#include <optional>

/// The dispatches of one pass that traces samples of pixels (reflect/tracer.cpp). Each path is a
/// dispatch, and the picture adds the paths up. The reason is a software driver that ends all loops
/// of an invocation after 65,535 iterations. One deep path stays below this limit. What all paths
/// of a camera ray share is traced once, in a dispatch of its own (shaders/lib/path_start.glsl).
namespace catoptric::reflect {

/// How the rays to the environment are spread over paths.
struct EnvironmentRaySchedule {
    std::uint32_t paths = 1; ///< for each ray of each sample
    std::uint32_t rays = 0;  ///< from one surface of a path; 0: objects do not hide the environment
};
/// Returns a schedule with at least as many rays for each sample as the scene asks for.
EnvironmentRaySchedule schedule_environment_rays(const TracerSettings& tracer,
                                                 const render::GpuScene& scene);

/// Returns the most rays that this tracer sends from the pixels of a picture: camera rays, and the
/// rays that leave the first surface where something is drawn at random.
std::uint64_t most_rays(const TracerSettings& tracer, const render::GpuScene& scene, uvec2 size);

/// Returns the number of work groups of 8x8 pixels.
std::uint32_t picture_groups(uvec2 size);

/// Pixels of a work group: 8x8 of a picture, or 64 of a list (kPixelsPerListGroup in
/// shaders/lib/trace_list.glsl).
inline constexpr std::uint32_t kPixelsPerWorkGroup = 64;

/// Dispatches work groups [first, first + groups), one invocation for each pixel, in pieces of the
/// frame if they are many. `parameters`: push constants.
template <typename Parameters>
void dispatch_groups(graph::PassCommands& commands, std::uint32_t first, std::uint32_t groups,
                     Parameters parameters) {
    commands.split_rays(groups, kPixelsPerWorkGroup, [&](std::uint32_t begin, uvec2 range) {
        parameters.first_group = first + begin;
        commands.push_constants(parameters);
        commands.dispatch(range.x, range.y);
    });
}

/// Buffers of the starts of paths that share a camera ray.
struct PathStarts {
    graph::BufferHandle starts, list, arguments;
};
/// Declares these buffers, if each camera ray has several paths.
std::optional<PathStarts> add_path_starts(graph::Graph& graph, const render::FrameInputs& inputs,
                                          const TracerSettings& tracer, const std::string& suffix);
void declare_path_starts(graph::PassBuilder& pass, const PathStarts& buffers);

/// The pixels to trace, the dispatch arguments in work groups, and counters.
struct TraceList {
    graph::BufferHandle pixels, arguments, counters;
};

/// Traces all samples of a picture's pixels, or of those in the list. `state`: the tracer.
/// `starts`: buffers of paths that share camera rays, if they do.
void trace_samples(graph::PassCommands& commands, gpu::ComputeState state,
                   const TracerSettings& tracer, const render::FrameInputs& inputs,
                   const TraceList* list, const std::optional<PathStarts>& starts);

} // namespace catoptric::reflect
