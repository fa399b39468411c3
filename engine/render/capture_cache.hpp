#pragma once

#include "gpu/buffer.hpp"
#include "render/captures.hpp"
#include "require/model.hpp"
#include "require/pieces.hpp"

#include <array>
#include <functional>
#include <memory>
#include <vector>

/// The capture cache keeps captures from frame to frame as long as the surfaces that they show do
/// not change. The captures lie in one of two sets of arrays. A frame that redraws captures samples
/// one set and fills the other, so that mirrors in the new captures show the captures of the frame
/// before. A frame that redraws no capture uses one set and leaves it unchanged.
namespace catoptric::render {

struct CachedFace {
    /// Content hash of all surfaces and lights that the face shows, except mirrors; 0: the contents
    /// of the face are invalid.
    std::uint64_t content_hash = 0;
    std::uint64_t drawing = 0; ///< identifies the picture: equal numbers mean equal bytes; 0: none
    bool is_behind = false; ///< whether the face shows an old state, because its redraw had to wait
    /// Content hash of all surfaces and lights that the face shows, except mirrors and the moving
    /// objects in `pieces`.
    std::uint64_t still_hash = 0;
    std::shared_ptr<const require::MovingParts>
        pieces; ///< parts of moving objects that the faces showed when `content_hash` was made
    bool operator==(const CachedFace&) const = default;
};

/// How a mirror's capture changed since the frame before.
enum class CaptureChange {
    none,
    /// The capture was redrawn only because captures of other mirrors changed; may be equal.
    unknown,
    some, ///< the capture changed, or may have changed for another reason
};

/// The captures that a frame leaves for the next frame, with their content hashes.
struct CaptureCache {
    std::vector<CaptureOptions> options; ///< settings that determine the layout of the arrays
    std::uint32_t set = 0;               ///< index of the set in use, of the two
    std::vector<std::array<CachedFace, 6>> faces; ///< the six faces of each mirror's capture
    std::vector<CaptureChange> changes; ///< change of each mirror's capture since the frame before
    /// For each mirror: for how many frames the redraw of its capture has waited.
    std::vector<std::uint32_t> waited;
    bool is_late = false; ///< a capture that had waited was drawn, and `saw` does not record that
    // Valid while some change is unknown:
    /// For each mirror: the other mirrors that are visible in the faces of its capture whose change
    /// is unknown.
    std::vector<std::vector<std::uint32_t>> saw;
    std::shared_ptr<CaptureCache> before;
    /// Results of the device's comparison of old and new captures: one word per mirror, not 0 if
    /// the captures differ. Valid once the frame has ended.
    std::shared_ptr<const gpu::Buffer> differing;
    std::uint64_t frame = 0; ///< number of the frame; the caller sets it
};

/// Returns, for each mirror, whether its capture may differ from the frame before. An unknown
/// change counts as a change if one of the mirrors that the capture showed had changed. If none had
/// changed, the redrawn capture equals the old one.
std::vector<char> find_changed(const CaptureCache& captures);

/// Reads the results of comparisons in frames that have ended, for these captures and the frames
/// before. `has_ended`: called with CaptureCache::frame.
void read_comparisons(const std::shared_ptr<CaptureCache>& captures,
                      const std::function<bool(std::uint64_t)>& has_ended);

/// Marks all captures as unchanged since the frame before, without a comparison.
void mark_unchanged(CaptureCache& captures);

/// What a frame does with one face of a capture.
enum class FaceUpdate : std::uint8_t {
    keep,
    clear, ///< clear the face, which has no contents yet and which no ray can ask for
    draw,  ///< draw the face, because the surfaces or lights that it shows have changed
    /// Draw the face because mirrors in it may have changed, then compare it with the frame before.
    compare,
};

/// What a frame does with its captures.
struct CaptureWork {
    /// Work on each face of each mirror; empty: all six faces are drawn.
    std::vector<std::array<FaceUpdate, 6>> faces;
    /// For each mirror: the part of each face that is redrawn. Outside the part, the texels equal
    /// those of the frame before.
    std::vector<std::array<require::FacePart, 6>> parts;
    FaceUpdate face_work(std::uint32_t mirror, std::uint32_t face) const {
        return faces.empty() ? FaceUpdate::draw : faces[mirror][face];
    }
    require::FacePart drawn_part(std::uint32_t mirror, std::uint32_t face) const {
        return parts.empty() ? require::FacePart() : parts[mirror][face];
    }
    bool is_drawn(std::uint32_t mirror, std::uint32_t face) const {
        return face_work(mirror, face) == FaceUpdate::draw ||
               face_work(mirror, face) == FaceUpdate::compare;
    }
};

/// The captures of a frame, the captures that they were copied or drawn from, and the capture cache
/// for the next frame.
struct CaptureUpdate {
    std::shared_ptr<const MirrorCaptures> captures; ///< captures that the frame samples
    /// Captures that other captures sample; null: none existed.
    std::shared_ptr<const MirrorCaptures> last;
    std::vector<bool> was_there; ///< for each mirror: whether `last` has a capture of the mirror
    CaptureWork work;
    std::shared_ptr<CaptureCache> kept; ///< cache of captures; null: captures do not persist
};

/// The buffers of a session into which comparisons write their results.
class ComparisonBuffers {
public:
    /// `has_ended`: returns whether the frame with the given number has ended.
    ComparisonBuffers(gpu::Device& device, std::function<bool(std::uint64_t)> has_ended)
        : device_(device), has_ended_(std::move(has_ended)) {}
    /// Returns a buffer of zeros, one word a mirror, that neither the host nor the device uses.
    std::shared_ptr<gpu::Buffer> buffer(std::size_t mirrors);
    /// Records that the frame `frame`, just submitted, writes to the buffer. Null is ignored.
    void mark_used(const std::shared_ptr<const gpu::Buffer>& buffer, std::uint64_t frame);

private:
    struct PooledBuffer {
        /// A buffer of comparison results, which can be used again if this is its only owner.
        std::shared_ptr<gpu::Buffer> buffer;
        std::uint64_t frame = 0; ///< number of the last frame that wrote to it
    };
    gpu::Device& device_;
    std::function<bool(std::uint64_t)> has_ended_;
    std::vector<PooledBuffer> entries_;
};

/// Declares all captures of this frame, and the captures of the previous frame that they read.
/// Every capture is drawn again in each frame.
CaptureUpdate update_all_captures(graph::Graph& graph, const FrameInputs& inputs,
                                  const std::string& name, std::vector<CaptureOptions> options);

/// The state from which the captures of a frame sequence continue.
struct PreviousCaptures {
    /// Captures of the frame before; null: this is the first frame.
    std::shared_ptr<CaptureCache> before;
    /// Buffers for the results of comparing captures. Null: the frame does not belong to the frame
    /// sequence and leaves nothing for the next frame.
    ComparisonBuffers* comparisons = nullptr;
    /// The capture budget: the most mirrors whose captures are drawn again; 0: no limit. The other
    /// captures stay as they are. A capture without valid contents in a needed face does not count
    /// and is always drawn.
    std::uint32_t most = 0;
};

/// Returns whether some capture is not drawn again in each frame (CaptureOptions::every).
bool take_turns(const std::vector<CaptureOptions>& options);

/// Returns whether the next frame must first read the comparisons of this frame. The order of
/// captures under a budget or in turns depends on their results.
bool must_read_comparisons(const CaptureCache& captures, std::uint32_t most);

/// Decides which captures must be drawn, given those of the frame before. A model that culls
/// nothing asks for all captures whose turn it is. Declares the arrays, and
/// the pass that copies unchanged faces into the set that the frame fills. Throws `internal` if
/// must_read_comparisons holds and `read_comparisons` was not called. Costs
/// O(mirrors seen by mirrors).
CaptureUpdate update_required_captures(graph::Graph& graph, const FrameInputs& inputs,
                                       const std::string& name,
                                       const std::vector<CaptureOptions>& options,
                                       const require::WorkModel& model,
                                       const PreviousCaptures& sequel);

/// Declares the pass that compares captures with those of the frame before. Call it after the
/// captures are drawn. Declares nothing if no capture needs a comparison.
void add_comparison_pass(graph::Graph& graph, const FrameInputs& inputs,
                         const CaptureUpdate& feeding);

/// Calls visit(first, end) for each run of a mirror's six faces for which the predicate `is`
/// returns true.
template <typename Is, typename Visit>
void for_each_face_range(Is&& is, Visit&& visit) {
    for (std::uint32_t first = 0; first < 6; ++first) {
        std::uint32_t end = first;
        while (end < 6 && is(end)) ++end;
        if (end > first) visit(first, end);
        first = end;
    }
}

} // namespace catoptric::render
