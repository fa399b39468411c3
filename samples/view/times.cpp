#include "times.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <algorithm>

namespace catoptric::view {

namespace {

bool have_equal_passes(const session::FrameTimes& a, const session::FrameTimes& b) {
    return std::ranges::equal(a.passes, b.passes, {}, &session::PassTime::name,
                              &session::PassTime::name);
}

} // namespace

void TimeStatistics::add(FrameTimeSample sample) {
    if (!samples_.empty() && !have_equal_passes(samples_.back().frame, sample.frame))
        samples_.clear();
    samples_.push_back(std::move(sample));
    if (samples_.size() > kAveragedFrames) samples_.pop_front();
}

template <typename Get>
TimeTableRow TimeStatistics::make_time_row(const std::string& name, const Get& get) const {
    std::vector<double> values;
    for (const FrameTimeSample& sample : samples_) values.push_back(get(sample));
    if (values.empty()) return {name, 0, {}};
    return {name, measure::percentile(values, .5), measure::median_interval(values)};
}

std::vector<TimeTableRow> TimeStatistics::list_pass_times() const {
    std::vector<TimeTableRow> lines;
    for (std::size_t i = 0; !samples_.empty() && i < samples_.back().frame.passes.size(); ++i)
        lines.push_back(
            make_time_row(samples_.back().frame.passes[i].name,
                          [i](const FrameTimeSample& s) { return s.frame.passes[i].ms(); }));
    return lines;
}

std::vector<TimeTableRow> TimeStatistics::host() const {
    return {
        make_time_row("update", [](const FrameTimeSample& s) { return s.frame.host.update; }),
        make_time_row("hierarchy", [](const FrameTimeSample& s) { return s.frame.host.hierarchy; }),
        make_time_row("compile", [](const FrameTimeSample& s) { return s.frame.host.compile; }),
        make_time_row("record", [](const FrameTimeSample& s) { return s.frame.host.record; }),
        make_time_row("host, by the clock", [](const FrameTimeSample& s) { return s.host_ms; }),
        make_time_row("acquire", [](const FrameTimeSample& s) { return s.acquire_ms; }),
        make_time_row("present", [](const FrameTimeSample& s) { return s.present_ms; })};
}

TimeTableRow TimeStatistics::gpu() const {
    return make_time_row("gpu", [](const FrameTimeSample& s) { return s.frame.gpu_ms; });
}

TimeTableRow TimeStatistics::frame() const {
    return make_time_row("frame", [](const FrameTimeSample& s) { return s.frame.frame_ms(); });
}

double TimeStatistics::fps() const {
    const double ms = make_time_row("", [](const FrameTimeSample& s) {
                          return s.interval_ms;
                      }).median;
    return ms > 0 ? 1000 / ms : 0;
}

} // namespace catoptric::view
