#pragma once

#include "core/error.hpp"
#include "graph/access.hpp"

namespace catoptric::graph {

/// The failure of a graph that its caller declared wrongly.
constexpr auto kInvalidGraph = Failure::internal;

/// Throws if a graph is contradictory (`Failure::internal`) or exceeds a limit
/// (`Failure::exhausted`). Checks every declared pass, also those that will be culled.
void validate(const Graph& graph, const Accesses& all, const GraphLimits& limits);

/// Checks one pass by itself: handles, uses, attachments, conflicts. Throws like `validate`.
void validate_pass(const Graph& graph, const Pass& pass, std::span<const Access> all,
                   const GraphLimits& limits);

} // namespace catoptric::graph
