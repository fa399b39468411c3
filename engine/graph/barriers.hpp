#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Fills the barriers of every pass and `plan.last`. Needs placements, because a pass waits for the
/// earlier users of its memory.
void plan_barriers(const Graph& graph, const GraphAccesses& all, GraphPlan& plan);

} // namespace catoptric::graph
