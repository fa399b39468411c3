#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Fills the barriers of every pass and `plan.last`. Memory must be placed before, because a pass
/// waits for earlier passes that used the same memory.
void plan_barriers(const Graph& graph, const GraphAccesses& all, GraphPlan& plan);

} // namespace catoptric::graph
