#pragma once

#include "../core/export.hpp"
#include "session.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::session {

/// A run of frames: what the first frame shows, in which scene, and the number of frames.
struct Request : FrameSpec {
    scene::Scene scene;            ///< the scene with all objects at rest
    std::optional<double> load_ms; ///< time that the caller took to read or make the scene
    int frames = 20;               ///< number of measured frames
    /// Number of frames that are rendered before the measured frames. Frame numbers count from 1 at
    /// the first of them, which has no history.
    int warmup = 8;
    /// Whether the run ends with the first picture that cannot change any more. Without history, it
    /// is the first. Otherwise its linear pictures and all captures equal those of the frame
    /// before, byte for byte, and no capture waits. With a limit on captures
    /// (FrameSpec::most_captures, budget_ms) each frame of the run is repeated until each capture
    /// had its turn.
    bool until_settled = false;
    bool auto_exposure = false; ///< `exposure` must still be found (session/exposure.hpp)
    /// Whether the scene moves: frame k shows the instant time + (k-1)/60 s. False: all frames show
    /// the instant `time`.
    bool animate = false;

    int total() const { return warmup + frames; }
    /// Returns the seconds into the scene's motion of frame k, from 1.
    double instant(int k) const { return time + (animate ? (k - 1) / 60.0 : 0.0); }
};

struct RunResult {
    std::vector<TechniqueResult> parts; ///< one per technique, of the last frame
    std::vector<FrameTimes> frames;     ///< measured frames; fewer if the picture settled
    bool settled = false; ///< no further frame would differ; only set with `until_settled`
};

/// Observer of long work, such as a comparison. The members are called with the progress, and can
/// end the work. All members are optional.
struct Watcher {
    /// Called before each row with its label, its number from 0, and the number of rows.
    std::function<void(const std::string&, std::size_t, std::size_t)> on_row;
    /// Called after each frame with its number from 1, and the largest possible number of frames.
    std::function<void(int, int)> on_frame;
    /// Called between pieces of a frame that traces many rays: rays so far, most rays of the frame.
    std::function<void(std::uint64_t, std::uint64_t)> on_piece;
    /// Points to the number of the signal that asks the work to stop; 0: no signal has arrived. The
    /// caller owns the number and may write it in a signal handler.
    const std::atomic<int>* stop = nullptr;
};

/// Renders all frames of a request in a session of its scene. The watcher may end the run.
CATOPTRIC_API RunResult run(Session& session, const Request& request, const Watcher& watcher = {});
/// Renders all frames of a request in a session of their own.
CATOPTRIC_API RunResult run(Engine& engine, const Request& request);

} // namespace catoptric::session
