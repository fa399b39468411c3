#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// How a graph fails that its caller declared wrongly.
constexpr auto kInvalidGraph = Failure::internal;

/// Refuses a graph that cannot mean anything (`Failure::internal`) or is over a limit
/// (`Failure::exhausted`). Culled or not: every declared pass is looked at.
void validate(const Graph& graph, const Accesses& all, const Limits& limits);

/// The part of `validate` that needs one pass only: handles, uses, attachments, conflicts.
void validate_pass(const Graph& graph, const Pass& pass, std::span<const Access> all,
                   const Limits& limits);

} // namespace catoptric::graph
