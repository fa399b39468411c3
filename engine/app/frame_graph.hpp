#pragma once

#include "app/session.hpp"
#include "graph/plan.hpp"
#include "graph/run.hpp"
#include "reflect/frame.hpp"

#include <memory>
#include <vector>

/// A frame between its specification and what is read of it. Internal: names Vulkan.
namespace catoptric::app {

/// One technique's share of a frame's graph.
struct Declared {
    reflect::Plan plan;
    reflect::Assignment assignment;
    std::string prefix;
    reflect::Outputs outputs;
    graph::Image display;
    std::optional<CaptureBudget> slices; ///< see Frame::slices
};

struct FrameGraph {
    graph::Graph graph;
    std::vector<Declared> parts;
    std::shared_ptr<graph::Physical> target; ///< of an embedder; may be none
};

/// Throws `usage` for none, for an unknown one and for one that is there twice.
std::vector<reflect::Plan> parse_plans(const std::vector<std::string>& techniques);

/// Every technique's passes and its compose, and what is wanted of them.
/// `mirrors`: their names; `keeping`: of each plan. Throws `usage` for a plan that does not fit
/// them.
FrameGraph declare(const FrameSpec& spec, const std::vector<reflect::Plan>& plans,
                   const std::vector<std::string>& mirrors, const render::GpuScene& scene,
                   graph::History history, const std::vector<reflect::CaptureHistory>& keeping);

/// Whether captures are kept, or a pass of the part reads what the frame before left.
bool remembers(const FrameGraph& frame, const graph::Plan& plan, const Declared& part);

measure::Picture read_hdr(graph::Runner& runner, graph::Ticket ticket, const Declared& declared,
                          uvec2 size);
/// `part`: index into the frame's parts; `mirrors`: their names. Throws `exhausted` where rays gave
/// up.
Part read_part(graph::Runner& runner, graph::Ticket ticket, const FrameGraph& frame,
               std::size_t part, const std::vector<std::string>& mirrors,
               const render::GpuScene& scene, const FrameSpec& spec);

} // namespace catoptric::app
