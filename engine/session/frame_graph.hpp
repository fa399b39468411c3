#pragma once

#include "graph/plan.hpp"
#include "graph/run.hpp"
#include "reflect/frame.hpp"
#include "session/access.hpp"
#include "session/session.hpp"

#include <memory>
#include <vector>

/// Builds the render graph of a frame and reads its results. Internal: uses Vulkan names.
namespace catoptric::app {

/// The part of a frame's graph that belongs to one technique.
struct Declared {
    reflect::Plan plan;
    reflect::Assignment assignment;
    std::string prefix;
    reflect::Outputs outputs;
    graph::ImageHandle display;
    std::optional<CaptureBudget> slices; ///< see Frame::slices
};

struct FrameGraph {
    graph::Graph graph;
    std::vector<Declared> parts;
    std::shared_ptr<graph::Physical> target; ///< image of an embedding program; may be null
};

/// Parses the plans of all techniques. Throws `usage` for an empty list, an unknown technique, and
/// a technique that is listed twice.
std::vector<reflect::Plan> parse_plans(const std::vector<std::string>& techniques);

/// Declares the passes of every technique, the pass that composes its picture, and its outputs.
/// `mirrors`: names of the mirrors. `keeping`: capture history of each plan. Throws `usage` for a
/// plan that does not fit the mirrors.
FrameGraph declare(const FrameSpec& spec, const FrameHooks& hooks,
                   const std::vector<reflect::Plan>& plans, const std::vector<std::string>& mirrors,
                   const render::GpuScene& scene, graph::History history,
                   const std::vector<reflect::CaptureHistory>& keeping);

/// Returns whether the part keeps captures, or one of its passes reads data of the frame before.
bool remembers(const FrameGraph& frame, const graph::GraphPlan& plan, const Declared& part);

measure::Picture read_hdr(graph::Runner& runner, graph::Ticket ticket, const Declared& declared,
                          uvec2 size);
/// Reads the results of a part. `part`: index into the frame's parts. `mirrors`: names of the
/// mirrors. Throws `exhausted` if rays took more steps than allowed.
Part read_part(graph::Runner& runner, graph::Ticket ticket, const FrameGraph& frame,
               std::size_t part, const std::vector<std::string>& mirrors,
               const render::GpuScene& scene, const FrameSpec& spec);

} // namespace catoptric::app
