#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// For each pass of a valid graph, whether anything wanted depends on it, in this frame or, through
/// `previous`, in the next.
std::vector<char> survivors(const Graph& graph, const Accesses& all);

/// "nobody wants what it writes: 'x', 'y'"
std::string cull_reason(const Graph& graph, std::span<const Access> accesses);

} // namespace catoptric::graph
