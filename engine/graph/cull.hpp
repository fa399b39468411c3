#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// What becomes of a pass.
struct Fate {
    bool survives = false;
    std::uint32_t unread = 0; ///< as PlannedPass::unread
};

/// For each pass of a valid graph, whether anything wanted depends on it, in this frame or, through
/// `previous`, in the next. What is kept or imported is wanted.
std::vector<Fate> fates(const Graph& graph, const Accesses& all);

/// "nobody wants what it writes: 'x', 'y'"
std::string cull_reason(const Graph& graph, std::span<const Access> accesses);

} // namespace catoptric::graph
