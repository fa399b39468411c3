#pragma once

#include "graph/graph.hpp"

namespace catoptric::graph {

/// Returns a hash that is equal for all graphs with the same shape. The shape is everything on
/// which a plan depends: every declaration, and which parts of persistent images have contents.
/// Recorded commands, clear values, content hashes and the identity of imported resources are not
/// part of the shape.
std::uint64_t hash_shape(const Graph& graph);

/// Returns whether the plan of graph `known` is also valid for `graph`. `known` need not have
/// callbacks that record its passes.
bool same_declarations(const Graph& graph, const Graph& known);

} // namespace catoptric::graph
