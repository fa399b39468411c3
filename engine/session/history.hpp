#pragma once

#include "graph/persistent_resources.hpp"
#include "reflect/plan.hpp"
#include "render/capture_cache.hpp"
#include "render/frame_facts.hpp"
#include "session/capture_cost.hpp"
#include "session/session.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// All that frames leave for later frames, as one value. What a later frame may read belongs here,
// and nowhere else. Session::Impl holds what is the same without earlier frames: the scene on the
// device, compiled graphs, models.
namespace catoptric::session {

/// A submitted frame under a budget whose times were not read yet.
struct TimedFrame {
    std::uint64_t frame = 0; ///< number of the frame
    /// For each technique, the prefix of its passes' names and the number of mirrors it drew.
    std::vector<std::pair<std::string, std::uint32_t>> drawn;
};

/// The edges that the captures of a sequence need. They stay, because cubes that change size lose
/// the contents of the frame before.
struct FaceEdges {
    uvec2 size{0, 0};          ///< size of the picture for which they were found
    std::vector<double> needs; ///< texels, by mirror; 0: not in the picture
};

struct History {
    graph::RetainedResources retained; ///< images and buffers
    /// Techniques and work of the frames. A frame with others begins without history.
    std::vector<reflect::TechniquePlan> plans;
    RenderedWork work = RenderedWork::everything;
    /// The texts that `plans` were read from; empty after a cut or an edit, when `auto` chooses
    /// again. `auto` keeps its choice for frames of the same texts.
    std::vector<std::string> texts;
    /// Captures that the last frame kept, by technique; null: it kept none.
    std::vector<std::shared_ptr<render::CaptureCache>> captures;
    std::vector<CaptureCost> costs; ///< of captures, by technique
    std::optional<TimedFrame> timed;
    std::optional<FaceEdges> face_edges;
    std::optional<render::FrameFacts> last; ///< facts of the last frame; none: there is none
    std::uint64_t units = 0;                ///< Session::Impl::units in which captures were drawn
    std::uint64_t edits = 0;                ///< Session::Impl::edits of the last frame
};

} // namespace catoptric::session
