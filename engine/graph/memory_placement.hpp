#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Fills `used`, `first`, `last` and `alone` of every image and buffer from the surviving passes.
void find_resource_lifetimes(const Graph& graph, const GraphAccesses& all, GraphPlan& plan);

/// Fills offsets, bytes and heap sizes. Needs lifetimes. Resources that are alive at the same time
/// never overlap; others may.
void place_resources_in_memory(const Graph& graph, const MemoryRequirementQueries& sizer,
                               GraphPlan& plan);

} // namespace catoptric::graph
