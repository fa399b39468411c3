#pragma once

#include "graph/graph.hpp"

namespace catoptric::graph {

/// Returns a hash that is equal for all graphs of one shape. A shape is all that a plan depends on:
/// every declaration, and which parts of persistent images have contents. The shape excludes
/// recorded commands, clear values, content hashes and which outside resources are imported.
std::uint64_t hash_graph_shape(const Graph& graph);

/// Returns whether a plan of one graph is valid for the other. `known` need not have pass bodies.
bool have_equal_graph_declarations(const Graph& graph, const Graph& known);

} // namespace catoptric::graph
