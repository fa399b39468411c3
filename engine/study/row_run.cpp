#include "study/row_run.hpp"

#include "core/stopwatch.hpp"
#include "session/watcher.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace catoptric::study {

namespace {

/// Returns the seconds since about the start of the program.
double elapsed_seconds() {
    static const SteadyClock::time_point kProgramStart = SteadyClock::now();
    return std::chrono::duration<double>(SteadyClock::now() - kProgramStart).count();
}

Request with_frames(Request request, int frames) {
    request.frames += frames;
    return request;
}

} // namespace

int frames_of_round(int frames, int rounds, int index) {
    return frames / rounds + (index < frames % rounds ? 1 : 0);
}

int round_count(int frames, int asked) { return std::min(frames, asked); }

bool must_repeat_first_round(const std::string& device_type) { return device_type != "cpu"; }

RowMeasurement::RowMeasurement(Session& session, Request request, const Watcher& watcher,
                               int repeated_frames)
    : request_(with_frames(std::move(request), repeated_frames)), watcher_(watcher),
      repeated_frames_(repeated_frames), frames_(session, request_) {}

void RowMeasurement::repeat_first_round() {
    measure_round(repeated_frames_);
    first_round_again_ = std::move(rounds_.back());
    rounds_.pop_back();
}

void RowMeasurement::replace_first_round() { rounds_.front() = std::move(first_round_again_); }

void RowMeasurement::measure_round(int frames) {
    const auto render = [&](int count) {
        for (int k = 0; k < count && frames_.render_next(); ++k)
            report_frame(watcher_, frames_.frame_number(), request_.total());
    };
    if (rounds_.empty()) {
        noisy_ = !read_processor_times() &&
                 session::is_timing_noisy(read_machine_load(), read_process_seconds(),
                                          elapsed_seconds());
        render(request_.warmup);
    }
    const std::size_t before = frames_.times().size();
    const std::optional<ProcessorTimes> start = read_processor_times();
    render(frames);
    if (const std::optional<ProcessorTimes> end = read_processor_times(); start && end) {
        waiting_ += waiting_times(*start, *end);
        waited_ = waiting_share(waiting_);
        noisy_ = session::is_timing_noisy(waited_);
    }
    rounds_.emplace_back(frames_.times().begin() + static_cast<std::ptrdiff_t>(before),
                         frames_.times().end());
}

} // namespace catoptric::study
