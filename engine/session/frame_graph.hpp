#pragma once

#include "graph/graph_runner.hpp"
#include "graph/plan.hpp"
#include "reflect/frame.hpp"
#include "session/access.hpp"
#include "session/session.hpp"

#include <memory>
#include <vector>

/// Builds the render graph of a frame and reads its results. Internal: uses Vulkan names.
namespace catoptric::session {

/// The part of a frame's graph that belongs to one technique.
struct FramePart {
    reflect::TechniquePlan plan;
    reflect::Assignment assignment;
    std::string prefix;
    reflect::TechniqueOutputs outputs;
    std::optional<CaptureBudget> capture_budget; ///< see Frame::capture_budget
};

struct FrameGraph {
    graph::Graph graph;
    render::FrameRequests requests;
    std::vector<FramePart> parts;
    std::shared_ptr<graph::PhysicalImage> target; ///< image of an embedding program; may be null
};

/// Parses the plans of all techniques. Throws `usage` for an empty list, an unknown technique, and
/// a technique that is listed twice.
std::vector<reflect::TechniquePlan> parse_plans(const std::vector<std::string>& techniques);

/// Declares the passes of every technique, the pass that composes its picture, and its outputs.
/// `mirrors`: names of the mirrors. `keeping`: capture history of each plan. Throws `usage` for a
/// plan that does not fit the mirrors.
FrameGraph declare_frame(const FrameSpec& spec, const FrameHooks& hooks,
                         const render::FrameFacts& facts,
                         const std::vector<reflect::TechniquePlan>& plans,
                         const std::vector<std::string>& mirrors, const render::GpuScene& scene,
                         graph::GraphHistory history,
                         const std::vector<reflect::CaptureHistory>& keeping);

/// Returns whether a technique keeps captures, or one of its passes reads data of the previous
/// frame.
bool remembers(const FrameGraph& frame, const graph::GraphPlan& plan, const FramePart& part);

measure::Picture read_hdr(graph::GraphRunner& runner, graph::FrameTicket ticket,
                          const FramePart& declared, uvec2 size);
/// Reads the results of a part. `part`: index into the frame's parts. `mirrors`: names of the
/// mirrors. Throws `exhausted` if rays took more steps than allowed.
TechniqueResult read_result(graph::GraphRunner& runner, graph::FrameTicket ticket,
                            const FrameGraph& frame, std::size_t part,
                            const std::vector<std::string>& mirrors, const render::GpuScene& scene,
                            const FrameSpec& spec);

} // namespace catoptric::session
