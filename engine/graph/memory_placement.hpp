#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Finds when each image and buffer is in use, from the passes that were not culled. Fills their
/// members `used`, `first` and `last` (passes), and `alone`: no other memory may overlap theirs.
void find_resource_lifetimes(const Graph& graph, const GraphAccesses& all, GraphPlan& plan);

/// Fills offsets, bytes and heap sizes. Needs lifetimes. Resources that are alive at the same time
/// never overlap; others may.
void place_resources_in_memory(const Graph& graph, const MemoryRequirementQueries& sizer,
                               GraphPlan& plan);

} // namespace catoptric::graph
