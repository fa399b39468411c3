#pragma once

#include "reflect/plan.hpp"
#include "render/capture_cache.hpp"
#include "require/model.hpp"

namespace catoptric::reflect {

/// Input of add_frame_passes(): the work that the frame may leave out, and the captures of the
/// previous frame.
struct CaptureHistory {
    const require::WorkModel& model;
    /// TechniqueOutputs::kept of the previous frame; null for the first frame.
    std::shared_ptr<render::CaptureCache> before;
    /// Buffers for comparing captures with those of the previous frame; may be null.
    render::ComparisonBuffers* comparisons = nullptr;
    std::uint32_t most = 0;     ///< capture budget; see render::PreviousCaptures
    bool ignores_turns = false; ///< captures are drawn as with every=1
};
/// The model that culls no work, so that all captures are drawn.
inline const require::WorkModel kDrawEverythingModel;

/// Declares the passes of one frame: all that the mirrors' techniques need. If all mirrors share
/// one technique, the passes are those of this technique.
///
/// If mirrors have different techniques, the view is drawn by rasterisation. It is lit by the
/// finest shadow map that any of the techniques asks for. If any technique uses captures, all
/// mirrors get captures, so that the captures can show every mirror. Work that the model culls gets
/// no passes.
TechniqueOutputs add_frame_passes(graph::Graph& graph, const render::FrameInputs& inputs,
                                  const Assignment& assignment,
                                  const CaptureHistory& keeping = {.model = kDrawEverythingModel});

} // namespace catoptric::reflect
