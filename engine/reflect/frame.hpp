#pragma once

#include "reflect/plan.hpp"
#include "render/capture_cache.hpp"

namespace catoptric::reflect {

/// What a frame may leave out, and what it goes on from.
struct CaptureHistory {
    const require::Model& model;
    /// Outputs::kept of the frame before; null: there was none.
    std::shared_ptr<render::CaptureCache> before;
    render::Comparisons* comparisons = nullptr; ///< see render::PreviousCaptures
    std::uint32_t most = 0;                     ///< likewise
};
/// Nothing is left out.
inline const require::Model kEverything;

/// Declares the passes of one frame: the union of what the mirrors' techniques need. Where all
/// mirrors share one, the passes are that technique's; where they do not, the view is drawn, lit by
/// the finest shadow map that one of them asks for, and if one looks into captures that show last
/// frame's, every mirror has one, so that the others can show it. No pass is declared for what the
/// model leaves out.
Outputs add_frame(graph::Graph& graph, const render::FrameInputs& inputs,
                  const Assignment& assignment,
                  const CaptureHistory& keeping = {.model = kEverything});

} // namespace catoptric::reflect
