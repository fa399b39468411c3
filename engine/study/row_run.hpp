#pragma once

#include "session/frames.hpp"
#include "session/processor.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"

#include <limits>
#include <string>
#include <vector>

// Functions that measure rows in rounds. In each round a few frames of each row are measured in
// turn, so that a slow moment of the machine affects all rows.
namespace catoptric::study {

using namespace session;

/// Returns the number of frames in round `index` of `rounds`. Frames are spread evenly; the first
/// rounds get one more if needed. `frames` must be at least `rounds`.
int frames_of_round(int frames, int rounds, int index);
/// Returns the number of rounds: `asked`, but at most one per frame.
int round_count(int frames, int asked);

/// Returns whether rows on a device of this type ("cpu", "discrete" ...) measure their first round
/// again. A graphics card raises its clock only while it is busy, and other work interrupts the
/// first round: shaders are compiled and pictures judged. An NVIDIA H200 rendered the frames of a
/// first round up to 5.7 times more slowly than later ones.
bool must_repeat_first_round(const std::string& device_type);

/// A row under measurement: one technique, or several in each frame. Its history, frame number and
/// clock continue from round to round as if nothing ran in between.
class RowMeasurement {
public:
    /// The session shows the request's scene. The session and the watcher must outlive this object.
    /// `repeated_frames`: number of frames of `repeat_first_round`; 0: it is not called.
    RowMeasurement(Session& session, Request request, const Watcher& watcher,
                   int repeated_frames = 0);

    /// Measures `frames` frames. The first call renders the warm-up before them.
    void measure_round(int frames);
    /// After all rounds, measures frames again whose times replace the times of the first round. In
    /// a moving scene these frames show later instants. Afterwards, `results` returns the picture
    /// of the last of these frames.
    void repeat_first_round();
    void replace_first_round();
    /// Returns the results of the last frame. Call before `suspend_frames`.
    std::vector<TechniqueResult> results() const { return frames_.result().parts; }
    /// Frees the session for other frames until the next `measure_round`.
    void suspend_frames() { frames_.suspend(); }

    std::size_t technique_count() const { return request_.techniques.size(); }
    /// Returns the number of the last frame, from 1.
    int frame_number() const { return frames_.frame_number(); }
    const std::vector<std::vector<FrameTimes>>& rounds() const { return rounds_; }
    /// Returns the mean of the waited share over all rounds: the part of the time in which the
    /// row's threads waited for a processor. NaN if the system does not report waiting.
    double wait_share() const { return waited_; }
    /// Returns whether the row's threads had to wait for a processor because other programs used
    /// it.
    bool is_noisy() const { return noisy_; }

private:
    Request request_;
    const Watcher& watcher_;
    int repeated_frames_;
    FrameLoop frames_;
    std::vector<std::vector<FrameTimes>> rounds_;
    std::vector<FrameTimes> first_round_again_;
    WaitingTimes waiting_; ///< sum over all rounds
    double waited_ = std::numeric_limits<double>::quiet_NaN();
    bool noisy_ = false;
};

} // namespace catoptric::study
