#pragma once

#include "graph/plan.hpp"

#include <random>

namespace catoptric::graph {

/// Simulates a plan without using code of the planner. Returns a text for each error; empty if the
/// plan is correct.
///
/// Memory that another resource overwrites loses its contents. A touch that no barrier orders is a
/// race. A read in another layout is an error. In the end, all outputs must hold the same contents
/// as if each resource had its own memory and all passes had run.
std::vector<std::string> replay_graph_plan(const Graph& graph, const GraphPlan& plan,
                                           const MemorySizer& sizer);

/// Returns a random valid graph. Over many graphs, passes use resources in every way that a graph
/// allows.
Graph make_random_graph(std::mt19937& random);

} // namespace catoptric::graph
