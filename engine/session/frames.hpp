#pragma once

#include "session/access.hpp"
#include "session/run.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace catoptric::session {

/// The number of frames at the end of a run that keep the times of their passes. Earlier frames
/// keep only their total times, so that a long run takes little memory.
constexpr std::size_t kMaxDetailedFrames = 1000;

/// Which history the first frame of a FrameLoop has.
enum class StartHistory {
    none, ///< nothing: the loop begins with a cut
    /// The captures of the session's last frame, which must have had the same techniques, instant
    /// and size. For settled pictures of one instant by several cameras.
    of_last_frame
};

/// The frames of a request, one after the other:
/// `for (FrameLoop frames(session, request); frames.render_next();) ...`
class FrameLoop {
public:
    /// Throws `usage` for less than one frame or a negative warm-up. The session shows the
    /// request's scene; session and request must outlive this object.
    FrameLoop(Session& session, const Request& request, const FrameHooks& hooks = {},
              StartHistory history = StartHistory::none);

    /// Returns false after the last frame.
    bool render_next() { return render_next(request_.camera); }
    /// As above, with this camera in place of the request's. A run that ends when the picture
    /// settles needs the same camera in each frame.
    bool render_next(const scene::Camera& camera) {
        return render_next(camera, request_.instant(number_ + 1));
    }
    /// As above, at this instant of the scene's motion, in seconds.
    bool render_next(const scene::Camera& camera, double time);
    /// Frees the session for other frames until the next call of `render_next`. That call continues
    /// the sequence as if no other frames had been rendered. Results of the last frame that were
    /// not read by then are lost.
    void suspend() { aside_.emplace(Access::suspend(session_)); }
    int frame_number() const { return number_; } ///< number of the last frame, from 1
    /// Returns the number of frames in all, if the picture does not settle earlier.
    int max_frames() const;
    const Frame& frame() const { return *frame_; }
    /// Returns the times of the measured frames so far.
    const std::vector<FrameTimes>& times() const { return times_; }
    /// Returns the results up to the frame rendered last.
    RunResult result() const;

private:
    /// Returns the frames within which each capture is drawn again; 1 without a limit.
    int cycle() const;

    Session& session_;
    const Request& request_;
    FrameHooks hooks_;
    int number_ = 0;
    bool settled_ = false;
    int equal_frames_ = 0; ///< last frames whose state is that of the frame before
    std::optional<Frame> frame_;
    std::optional<FrameSequence> aside_;
    std::vector<FrameTimes> times_;
    std::vector<std::byte> state_; ///< Access::read_state of the frame before, with `until_settled`
};

/// Renders all frames of a request, as session::run does, with this history.
RunResult run_with_history(Session& session, const Request& request, const Watcher& watcher,
                           StartHistory history);

} // namespace catoptric::session
