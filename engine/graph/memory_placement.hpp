#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Finds when each image and buffer is in use, from the passes that were not culled. Fills their
/// members `used`, `first` and `last` (passes), and `alone`: no other memory may overlap theirs.
void find_lifetimes(const Graph& graph, const GraphAccesses& all, GraphPlan& plan);

/// Fills the offsets and bytes of all images and buffers, and the sizes of the heaps. Lifetimes
/// must be known. Resources that are in use at the same time never overlap in memory.
void place_resources(const Graph& graph, const MemorySizer& sizer, GraphPlan& plan);

} // namespace catoptric::graph
