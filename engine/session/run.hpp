#pragma once

#include "../core/export.hpp"
#include "session.hpp"
#include "watcher.hpp"

#include <vector>

namespace catoptric::app {

/// A run of frames: what the first frame shows, in which scene, and the number of frames.
struct Request : FrameSpec {
    scene::Scene scene;            ///< the scene with all objects at rest
    std::optional<double> load_ms; ///< time that the caller took to read or make the scene
    int frames = 20;               ///< number of measured frames
    /// Number of frames that are rendered before the measured frames. Frame numbers count from 1 at
    /// the first of them, which has no history.
    int warmup = 8;
    /// Whether the run ends with the first picture that cannot change any more. If no technique has
    /// history, this is the first frame. Otherwise its linear pictures and all captures equal those
    /// of the frame before, byte for byte, and no capture has to wait. With a limit on captures per
    /// frame (FrameSpec::most_captures, budget_ms) each frame of the run is repeated until each
    /// capture had its turn.
    bool until_settled = false;
    bool auto_exposure = false; ///< `exposure` must still be found (session/exposure.hpp)
    /// Whether the scene moves: frame k shows the instant time + (k-1)/60 s. False: all frames show
    /// the instant `time`.
    bool animate = false;

    int total() const { return warmup + frames; }
    /// Returns the seconds into the scene's motion of frame k, from 1.
    double instant(int k) const { return time + (animate ? (k - 1) / 60.0 : 0.0); }
};

/// Number of the last frames of a run that keep the times of their passes. Older frames keep only
/// their totals, so that a long run takes little memory.
constexpr std::size_t kDetailedFrames = 1000;

struct Result {
    std::vector<Part> parts; ///< one per technique, of the last frame
    /// Measured frames; fewer than asked for if the picture settled.
    std::vector<FrameTimes> frames;
    /// Whether any further frame would show the same picture; only set with `until_settled`.
    bool settled = false;
};

/// The frames of a request, one after the other, from cold history:
/// `for (Frames frames(session, request); frames.next();) ...`
class Frames {
public:
    /// Begins with a cut. Throws `usage` for less than one frame or a negative warm-up. The session
    /// shows the request's scene; session and request must outlive this object.
    CATOPTRIC_API Frames(Session& session, const Request& request);

    /// Renders the next frame. Returns false after the last.
    CATOPTRIC_API bool next();
    /// Frees the session for other frames until the next call of `next`. That call continues the
    /// sequence as if no other frames had been rendered. Results of the last frame that were not
    /// read by then are lost.
    void suspend() { aside_.emplace(session_.suspend()); }
    int number() const { return number_; } ///< number of the last frame, from 1
    /// Returns the number of frames in all, if the picture does not settle earlier.
    CATOPTRIC_API int most_frames() const;
    const Frame& frame() const { return *frame_; }
    bool settled() const { return settled_; }
    /// Returns the times of the measured frames so far.
    const std::vector<FrameTimes>& times() const { return times_; }
    /// Returns the results up to the frame rendered last.
    CATOPTRIC_API Result result() const;

private:
    Session& session_;
    const Request& request_;
    int number_ = 0;
    bool settled_ = false;
    std::optional<Frame> frame_;
    std::optional<Sequence> aside_;
    std::vector<FrameTimes> times_;
    std::vector<std::byte> state_; ///< Frame::state of the frame before, with `until_settled`
};

/// Renders all frames of a request in a session of its scene. The watcher is told of each frame and
/// may end the run.
CATOPTRIC_API Result run(Session& session, const Request& request, const Watcher& watcher = {});
/// Renders all frames of a request in a session of their own.
CATOPTRIC_API Result run(Engine& engine, const Request& request);

} // namespace catoptric::app
