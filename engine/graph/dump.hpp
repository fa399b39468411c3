#pragma once

#include "graph/plan.hpp"

#include <string>

namespace catoptric::graph {

/// Returns the plan as text: passes in order with their reads and writes, culled passes with the
/// reason, images that share memory, scene_passes and bytes.
std::string graph_plan_to_text(const Graph& graph, const GraphPlan& plan);
/// Returns the plan in Graphviz's dot language: passes as boxes, images as ellipses, culled passes
/// dashed.
std::string graph_plan_to_graphviz_dot(const Graph& graph, const GraphPlan& plan);
/// {"passes":
/// [{"name","tag","reads":[{"image","layers":[first,count],"use","previous"}],"writes":[...],"barriers":n}],
///  "culled": [{"name","reason"}], "images":
///  [{"name","format","size","layers","first","last","offset","bytes","alone"}], "scene_passes",
///  "bytes", "bytes_unshared"}
std::string plan_to_json(const Graph& graph, const GraphPlan& plan);

} // namespace catoptric::graph
