#pragma once

#include "gpu/buffer.hpp"
#include "render/captures.hpp"
#include "require/model.hpp"
#include "require/pieces.hpp"

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <vector>

/// Captures that stay as long as what they show does. They lie in one of two sets of arrays: a
/// frame that draws some of them anew looks into the one set and fills the other, so that each of
/// its mirrors shows the frame before; a frame that draws none uses the set as it is.
namespace catoptric::render {

/// A face of a mirror's capture.
struct CachedFace {
    std::uint64_t content_hash = 0; ///< of what it shows but for mirrors; 0: of nothing any more
    std::uint64_t drawing = 0;  ///< which picture it is: the same number, the same bytes; 0: none
    bool is_behind = false;     ///< it was to be drawn anew and was put off
    std::uint64_t settings = 0; ///< of what it shows but for mirrors and `pieces`
    std::shared_ptr<const require::Pieces> pieces; ///< of the mirror, when the stamp was this
    bool operator==(const CachedFace&) const = default;
};

/// What became of a mirror's capture in a frame, against the frame before.
enum class Change {
    none,
    unknown, ///< drawn anew, and only since other mirrors' captures had changed
    some,    ///< or it may have
};

/// The captures that a frame left, for the next one to go on from.
struct CaptureCache {
    std::vector<CaptureOptions> options;          ///< after which they lie in the arrays
    std::uint32_t set = 0;                        ///< of the two
    std::vector<std::array<CachedFace, 6>> faces; ///< of each mirror
    std::vector<Change> changes;                  ///< of each mirror
    std::vector<std::uint32_t> waited; ///< of each mirror: frames for which it has been put off
    bool is_late = false; ///< somebody was drawn who had waited: `saw` does not tell of it
    // While some change is unknown:
    std::vector<std::vector<std::uint32_t>> saw; ///< of each mirror: whom those faces show
    std::shared_ptr<CaptureCache> before;
    std::shared_ptr<const gpu::Buffer> differing; ///< a word a mirror, once the frame has ended
    std::uint64_t frame = 0; ///< that was submitted with it, which its caller says
};

/// Of each mirror, whether its capture is another one than a frame before, for all that is known.
/// The unknown is told by what it saw: where nothing of that had changed, what was drawn again is
/// the same.
std::vector<char> changed(const CaptureCache& captures);

/// Reads what comparisons of frames that have ended have found, along the frames before it.
/// `has_ended`: asked with CaptureCache::frame.
void learn(const std::shared_ptr<CaptureCache>& captures,
           const std::function<bool(std::uint64_t)>& has_ended);

/// As if comparisons had found all as it was.
void find_unchanged(CaptureCache& captures);

/// What a frame does with a face.
enum class FaceWork : std::uint8_t {
    keep,
    clear,   ///< nobody looks, and there is nothing yet
    draw,    ///< what it shows is another thing now
    compare, ///< draw, since mirrors in it may have changed, and tell whether it did
};

/// What a frame does with its captures.
struct CaptureWork {
    std::vector<std::array<FaceWork, 6>> faces; ///< of each mirror; empty: all six are drawn
    /// Of those that are drawn: outside of it they are what they were in the frame before.
    std::vector<std::array<require::FacePart, 6>> parts;
    FaceWork of(std::uint32_t mirror, std::uint32_t face) const {
        return faces.empty() ? FaceWork::draw : faces[mirror][face];
    }
    require::FacePart part(std::uint32_t mirror, std::uint32_t face) const {
        return parts.empty() ? require::FacePart() : parts[mirror][face];
    }
    bool is_drawn(std::uint32_t mirror, std::uint32_t face) const {
        return of(mirror, face) == FaceWork::draw || of(mirror, face) == FaceWork::compare;
    }
};

/// Captures of a frame, what they are made from, and what is left for the next.
struct CaptureUpdate {
    std::shared_ptr<const Captures> captures; ///< that the frame looks into
    std::shared_ptr<const Captures> last;     ///< that captures look into; null: nothing was there
    std::vector<bool> was_there;              ///< of each mirror, in `last`
    CaptureWork work;
    std::shared_ptr<CaptureCache> kept; ///< null: nothing is kept
};

/// Where comparisons write what they found; of one session.
class Comparisons {
public:
    /// `has_ended`: asked with the numbers of frames.
    Comparisons(gpu::Device& device, std::function<bool(std::uint64_t)> has_ended)
        : device_(device), has_ended_(std::move(has_ended)) {}
    /// A buffer of zeros that neither host nor device has, a word a mirror.
    std::shared_ptr<gpu::Buffer> buffer(std::size_t mirrors);
    /// The frame was submitted that writes to it; null: none does.
    void used(const std::shared_ptr<const gpu::Buffer>& buffer, std::uint64_t frame);

private:
    struct Entry {
        std::shared_ptr<gpu::Buffer> buffer; ///< free where nobody else holds it
        std::uint64_t frame = 0;             ///< that wrote to it last
    };
    gpu::Device& device_;
    std::function<bool(std::uint64_t)> has_ended_;
    std::vector<Entry> entries_;
};

/// Everything anew in each frame, beside last frame's: declares both.
CaptureUpdate update_all_captures(graph::Graph& graph, const FrameInputs& inputs,
                                  const std::string& name, std::vector<CaptureOptions> options);

/// What captures of a sequence go on from.
struct PreviousCaptures {
    std::shared_ptr<CaptureCache> before; ///< of the frame before; null: there was none
    /// null: the frame is beside the sequence, and so tells the next one nothing.
    Comparisons* comparisons = nullptr;
    /// Mirrors that are drawn again at most; 0: all. Others are put off and stay as they are;
    /// whoever holds nothing of what is looked at, or something that nobody kept up, is drawn
    /// beside them.
    std::uint32_t most = 0;
};

/// Whether the next frame must know what comparisons found: whose turn it is depends on that.
bool must_learn(const CaptureCache& captures, std::uint32_t most);

/// What of the captures has to be drawn, given those of the frame before; declares the arrays, and
/// the pass that brings what stays into the set that the frame fills. Throws `internal` where it
/// must_learn and did not. O(mirrors seen by mirrors).
CaptureUpdate update_required_captures(graph::Graph& graph, const FrameInputs& inputs,
                                       const std::string& name,
                                       const std::vector<CaptureOptions>& options,
                                       const require::Model& model, const PreviousCaptures& sequel);

/// After the captures are drawn: declares the pass that tells which of those that were to be
/// compared differ from the frame before. None where none was.
void add_comparison(graph::Graph& graph, const FrameInputs& inputs, const CaptureUpdate& feeding);

/// Calls visit(first, end) for each run of faces of a mirror, of six, for which `is` holds.
template <typename Is, typename Visit>
void for_each_run(Is&& is, Visit&& visit) {
    for (std::uint32_t first = 0; first < 6; ++first) {
        std::uint32_t end = first;
        while (end < 6 && is(end)) ++end;
        if (end > first) visit(first, end);
        first = end;
    }
}

} // namespace catoptric::render
