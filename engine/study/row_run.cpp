#include "study/row_run.hpp"

#include "core/stopwatch.hpp"
#include "session/watcher.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace catoptric::app {

namespace {

/// Returns the seconds since about the start of the program.
double elapsed_seconds() {
    static const SteadyClock::time_point kStart = SteadyClock::now();
    return std::chrono::duration<double>(SteadyClock::now() - kStart).count();
}

} // namespace

int frames_of_round(int frames, int rounds, int index) {
    return frames / rounds + (index < frames % rounds ? 1 : 0);
}

int rounds_of(int frames, int asked) { return std::min(frames, asked); }

RowRun::RowRun(Session& session, Request request, const Watcher& watcher)
    : request_(std::move(request)), watcher_(watcher), frames_(session, request_) {}

void RowRun::measure(int frames) {
    const auto render = [&](int count) {
        for (int k = 0; k < count && frames_.next(); ++k)
            tell_frame(watcher_, frames_.number(), request_.total());
    };
    if (rounds_.empty()) {
        noisy_ = !processor_use() &&
                 app::is_noisy(machine_load(), process_seconds(), elapsed_seconds());
        render(request_.warmup);
    }
    const std::size_t before = frames_.times().size();
    const std::optional<ProcessorUse> start = processor_use();
    render(frames);
    if (const std::optional<ProcessorUse> end = processor_use(); start && end) {
        waiting_ += waiting_between(*start, *end);
        waited_ = waited_share(waiting_);
        noisy_ = app::is_noisy(waited_);
    }
    rounds_.emplace_back(frames_.times().begin() + static_cast<std::ptrdiff_t>(before),
                         frames_.times().end());
}

} // namespace catoptric::app
