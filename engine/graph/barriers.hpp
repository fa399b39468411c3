#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// Fills the barriers of every pass and `last`. Needs placements: memory that was used before is
/// waited for.
void order(const Graph& graph, const Accesses& all, Plan& plan);

} // namespace catoptric::graph
