#pragma once

#include "graph/plan.hpp"

#include <random>

namespace catoptric::graph {

/// Runs a plan on paper, without any code of the planner: memory that is overwritten loses its
/// contents, a touch that no barrier orders is a race, a read in another layout is a fault, and in
/// the end everything wanted must hold what it would hold if every pass had run with memory of its
/// own. Returns each broken promise; empty when the plan is right.
std::vector<std::string> replay(const Graph& graph, const Plan& plan, const Sizer& sizer);

/// A valid graph of up to 16 passes that uses everything that passes may use.
Graph random_graph(std::mt19937& random);

} // namespace catoptric::graph
