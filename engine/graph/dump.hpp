#pragma once

#include "graph/plan.hpp"

#include <string>

namespace catoptric::graph {

/// Returns the plan as text: passes in order with their reads and writes, culled passes with the
/// reason, images that share memory, scene_passes and bytes.
std::string plan_to_text(const Graph& graph, const GraphPlan& plan);
/// Returns the plan in Graphviz's dot language: passes as boxes, images as ellipses, culled passes
/// dashed.
std::string plan_to_dot(const Graph& graph, const GraphPlan& plan);
/// Returns the plan as JSON, with the members passes, culled, images, buffers, scene_passes, bytes
/// and bytes_unshared (pass_json and image_json in dump.cpp).
std::string plan_to_json(const Graph& graph, const GraphPlan& plan);

} // namespace catoptric::graph
