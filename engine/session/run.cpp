#include "session/run.hpp"

#include "core/error.hpp"
#include "session/access.hpp"
#include "session/frames.hpp"
#include "session/processor.hpp"
#include "session/watcher.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace catoptric::session {

namespace {

/// Throws if the device's clock stands still or jumps, because times would then mean nothing.
void check_device_clock(const FrameTimes& times) {
    constexpr double kMaxTimesWall = 10, kMaxMoreMs = 1000; // more than any inaccuracy
    check(
        times.passes.empty() || times.gpu_ms > 0, Failure::no_device,
        "the device's clock stands still: wanted timestamps that advance from pass to pass, found "
        "the same before and after ",
        times.passes.size(),
        " passes; times need another driver or device (--device), pictures do not ('render' "
        "without --frames)");
    check(times.gpu_ms <= kMaxTimesWall * times.wall_ms + kMaxMoreMs, Failure::no_device,
          "the device's clock jumps: wanted a time of at most the ", times.wall_ms,
          " ms between submit and end of the frame, found ", times.gpu_ms,
          " ms between its timestamps; times need another driver or device (--device)");
}

} // namespace

FrameLoop::FrameLoop(Session& session, const Request& request, const FrameHooks& hooks,
                     StartHistory history)
    : session_(session), request_(request), hooks_(hooks) {
    check(request.frames > 0 && request.warmup >= 0, Failure::usage,
          "frames must be at least 1 and warm-up at least 0, not ", request.frames, " and ",
          request.warmup);
    if (history == StartHistory::none) session.forget();
}

bool FrameLoop::render_next(const scene::Camera& camera, double time) {
    if (settled_ || number_ >= max_frames()) return false;
    check(!request_.until_settled || camera == request_.camera, Failure::usage,
          "a run until the picture settles: wanted one camera, found two");
    if (aside_) Access::resume(session_, std::move(*aside_));
    aside_.reset();
    ++number_;
    FrameSpec spec = request_;
    spec.camera = camera;
    spec.time = time;
    const double used_before = read_process_seconds();
    frame_ = Access::render_frame(session_, spec, hooks_);
    // The first measured frame must not wait for the frames before it.
    if (number_ == request_.warmup) frame_->times();
    if (number_ > request_.warmup) {
        times_.push_back(frame_->times());
        if (!request_.until_settled) check_device_clock(times_.back());
        times_.back().cpu_ms = 1e3 * (read_process_seconds() - used_before);
        if (times_.size() > kMaxDetailedFrames)
            times_[times_.size() - kMaxDetailedFrames - 1].passes = std::vector<PassTime>();
    }
    if (request_.until_settled) {
        std::vector<std::byte> state = Access::read_state(*frame_);
        equal_frames_ = state == state_ ? equal_frames_ + 1 : 0;
        // If all captures are drawn again in turns, none has changed after a whole cycle.
        const int wanted = request_.model == RenderedWork::everything ? cycle() : 1;
        settled_ = state.empty() || (equal_frames_ >= wanted && frame_->waiting() == 0);
        state_ = std::move(state);
    }
    return true;
}

int FrameLoop::cycle() const {
    std::uint32_t frames = 1;
    for (std::size_t i = 0; frame_ && i < frame_->size(); ++i)
        frames = std::max(
            frames, frame_->capture_budget(i) ? frame_->capture_budget(i)->frames_per_cycle() : 1);
    return static_cast<int>(frames);
}

/// With a limit on captures, a still picture needs as many cycles as it needs frames without one.
int FrameLoop::max_frames() const {
    const std::int64_t cycles = request_.until_settled ? cycle() : 1;
    return static_cast<int>(std::min<std::int64_t>(std::int64_t{request_.total()} * cycles,
                                                   std::numeric_limits<int>::max()));
}

RunResult FrameLoop::result() const { return {frame_->read_all(), times_, settled_}; }

RunResult run_with_history(Session& session, const Request& request, const Watcher& watcher,
                           StartHistory history) {
    const WatchedWork watched(watcher);
    FrameLoop frames(session, request, {}, history);
    throw_if_stopped(watcher);
    while (frames.render_next()) report_frame(watcher, frames.frame_number(), frames.max_frames());
    return frames.result();
}

RunResult run(Session& session, const Request& request, const Watcher& watcher) {
    return run_with_history(session, request, watcher, StartHistory::none);
}

RunResult run(Engine& engine, const Request& request) {
    Session session(engine, request.scene);
    return run(session, request);
}

} // namespace catoptric::session
