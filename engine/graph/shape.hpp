#pragma once

#include "graph/graph.hpp"

namespace catoptric::graph {

/// A number that all graphs of one shape have. A shape is what a plan depends on: everything that
/// is declared, and where kept images hold something; but not what passes record, the values
/// they clear to, stamps, and which things of somebody else's are imported.
std::uint64_t shape_hash(const Graph& graph);

/// Whether a plan of the one is a plan of the other. `known` may have lost its bodies.
bool has_shape(const Graph& graph, const Graph& known);

} // namespace catoptric::graph
