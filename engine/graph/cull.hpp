#pragma once

#include "graph/access.hpp"

namespace catoptric::graph {

/// The result of culling for one pass: whether the pass is executed, and which of its attachments
/// no later pass reads.
struct CullDecision {
    bool survives = false;
    std::uint32_t unread = 0; ///< bits as in PlannedPass::unread
};

/// Returns for each pass of a valid graph whether it is culled. A pass is kept if an output depends
/// on it, in this frame or, through `previous`, in the next. Persistent and imported images, and
/// imported buffers, count as outputs.
std::vector<CullDecision> cull_decisions(const Graph& graph, const GraphAccesses& all);

/// Returns the reason why a pass was culled, as text: "no output depends on what it writes: 'x',
/// 'y'".
std::string cull_reason(const Graph& graph, std::span<const ResourceAccess> accesses);

} // namespace catoptric::graph
