#pragma once

#include "core/error.hpp"
#include "graph/access.hpp"

namespace catoptric::graph {

/// The failure of a graph that its caller declared wrongly.
constexpr auto kInvalidGraph = Failure::internal;

/// Throws if a graph is contradictory (`Failure::internal`) or exceeds a limit
/// (`Failure::exhausted`). Checks every declared pass, also those that will be culled.
void validate_graph(const Graph& graph, const GraphAccesses& all, const GraphLimits& limits);

/// Checks one pass by itself: handles, uses, attachments, conflicts. Throws like `validate_graph`.
void validate_pass(const Graph& graph, const Pass& pass, std::span<const ResourceAccess> all,
                   const GraphLimits& limits);

} // namespace catoptric::graph
