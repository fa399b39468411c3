#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Fills `used`, `first`, `last` and `alone` of every image and buffer from the surviving passes.
void find_lifetimes(const Graph& graph, const Accesses& all, GraphPlan& plan);

/// Fills offsets, bytes and heap sizes. Needs lifetimes. Resources that are alive at the same time
/// never overlap; others may.
void place(const Graph& graph, const Sizer& sizer, GraphPlan& plan);

} // namespace catoptric::graph
