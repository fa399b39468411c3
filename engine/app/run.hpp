#pragma once

#include "../core/export.hpp"
#include "session.hpp"
#include "watcher.hpp"

#include <vector>

namespace catoptric::app {

/// A run of frames: what the first shows, in which scene, and how many follow.
struct Request : FrameSpec {
    scene::Scene scene;            ///< at rest
    std::optional<double> load_ms; ///< that the caller took to read or make it
    int frames = 20;               ///< measured
    int warmup = 8; ///< before them; frames count from 1 at cold history, these included
    /// End with the first frame that cannot change any more: at once where nothing is remembered,
    /// else when a frame's linear pictures and all captures equal those of the frame before, byte
    /// for byte, and no capture is put off. Under a limit (FrameSpec::most_captures, budget_ms) a
    /// frame counts as the round in which each capture has its turn.
    bool until_settled = false;
    bool auto_exposure = false; ///< `exposure` is still to be found (app/exposure.hpp)
    bool animate = false;       ///< frame k at time + (k-1)/60 s; otherwise all at `time`

    int total() const { return warmup + frames; }
    /// Seconds into the scene's motion of frame k, from 1.
    double instant(int k) const { return time + (animate ? (k - 1) / 60.0 : 0.0); }
};

/// How many frames of a run, the last ones, keep the times of their passes. Older frames keep their
/// totals alone, so a long run takes little memory.
constexpr std::size_t kDetailedFrames = 1000;

struct Result {
    std::vector<Part> parts;        ///< one per technique, of the last frame
    std::vector<FrameTimes> frames; ///< the measured ones; fewer than asked for where they settled
    bool settled = false;           ///< with `until_settled`: any further frame would show the same
};

/// The frames of a request, one after the other, from cold history:
/// `for (Frames frames(session, request); frames.next();) ...`
class Frames {
public:
    /// Throws `usage`. The session shows the request's scene; both must outlive this.
    CATOPTRIC_API Frames(Session& session, const Request& request);

    /// Renders the next one; false after the last.
    CATOPTRIC_API bool next();
    /// Other frames may follow in the session until the next call of `next`, which goes on as if
    /// there had been none. What is not read of the last frame by then is lost.
    void suspend() { aside_.emplace(session_.suspend()); }
    int number() const { return number_; } ///< of the frame that was rendered last, from 1
    /// Frames that there will be, where they do not settle.
    CATOPTRIC_API int most_frames() const;
    const Frame& frame() const { return *frame_; }
    bool settled() const { return settled_; }
    const std::vector<FrameTimes>& times() const { return times_; } ///< of the measured ones so far
    /// What there is after the frame that was rendered last.
    CATOPTRIC_API Result result() const;

private:
    Session& session_;
    const Request& request_;
    int number_ = 0;
    bool settled_ = false;
    std::optional<Frame> frame_;
    std::optional<Sequence> aside_;
    std::vector<FrameTimes> times_;
    std::vector<std::byte> state_; ///< of the frame before, with `until_settled`
};

/// All frames of a request in a session of its scene. The watcher is told of each and may end them.
CATOPTRIC_API Result run(Session& session, const Request& request, const Watcher& watcher = {});
/// The same in a session of its own.
CATOPTRIC_API Result run(Engine& engine, const Request& request);

} // namespace catoptric::app
