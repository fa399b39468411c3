#pragma once

#include "app/processor.hpp"
#include "app/run.hpp"
#include "app/watcher.hpp"

#include <limits>
#include <vector>

// Measuring in rounds: one row's frames after another's, so that what slows the machine down for a
// while slows them all.
namespace catoptric::app {

/// Frames of round `index` of `rounds`: as even as can be, the first ones the larger. In all they
/// are `frames`, which are at least as many as rounds.
int frames_of_round(int frames, int rounds, int index);
/// At most one round a frame.
int rounds_of(int frames, int asked);

/// A row under measurement: one technique, or several in each frame. Its history, frame number and
/// clock go on from round to round as if nothing ran between.
class RowRun {
public:
    /// The session shows the request's scene and must outlive this; so must the watcher.
    RowRun(Session& session, Request request, const Watcher& watcher);

    /// So many frames; before the first of all, those of the warm-up.
    void measure(int frames);
    /// Of the last frame, until `set_aside`.
    std::vector<Part> parts() const { return frames_.result().parts; }
    /// The session is free for others until the next `measure`.
    void suspend() { frames_.suspend(); }

    /// Of the last frame, from 1.
    int number() const { return frames_.number(); }
    const std::vector<std::vector<FrameTimes>>& rounds() const { return rounds_; }
    /// See waited_share, of all rounds; NaN where nobody tells.
    double waited() const { return waited_; }
    /// Its threads had to wait for a processor that others had.
    bool is_noisy() const { return noisy_; }

private:
    Request request_;
    const Watcher& watcher_;
    Frames frames_;
    std::vector<std::vector<FrameTimes>> rounds_;
    Waiting waiting_; ///< of all rounds
    double waited_ = std::numeric_limits<double>::quiet_NaN();
    bool noisy_ = false;
};

} // namespace catoptric::app
