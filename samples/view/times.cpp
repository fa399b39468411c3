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

void TimeStatistics::add(FrameSample sample) {
    if (!samples_.empty() && !have_equal_passes(samples_.back().frame, sample.frame))
        samples_.clear();
    samples_.push_back(std::move(sample));
    if (samples_.size() > kAveragedFrames) samples_.pop_front();
}

template <typename Get>
TimeRow TimeStatistics::time_row(const std::string& name, const Get& get) const {
    std::vector<double> values;
    for (const FrameSample& sample : samples_) values.push_back(get(sample));
    if (values.empty()) return {name, 0, {}};
    return {name, measure::percentile(values, .5), measure::median_interval(values)};
}

std::vector<TimeRow> TimeStatistics::list_pass_times() const {
    std::vector<TimeRow> lines;
    for (std::size_t i = 0; !samples_.empty() && i < samples_.back().frame.passes.size(); ++i)
        lines.push_back(time_row(samples_.back().frame.passes[i].name,
                                 [i](const FrameSample& s) { return s.frame.passes[i].ms(); }));
    return lines;
}

std::vector<TimeRow> TimeStatistics::host() const {
    return {time_row("update", [](const FrameSample& s) { return s.frame.host.update; }),
            time_row("hierarchy", [](const FrameSample& s) { return s.frame.host.hierarchy; }),
            time_row("compile", [](const FrameSample& s) { return s.frame.host.compile; }),
            time_row("record", [](const FrameSample& s) { return s.frame.host.record; }),
            time_row("host, by the clock", [](const FrameSample& s) { return s.host_ms; }),
            time_row("acquire", [](const FrameSample& s) { return s.acquire_ms; }),
            time_row("present", [](const FrameSample& s) { return s.present_ms; })};
}

TimeRow TimeStatistics::gpu() const {
    return time_row("gpu", [](const FrameSample& s) { return s.frame.gpu_ms; });
}

TimeRow TimeStatistics::frame() const {
    return time_row("frame", [](const FrameSample& s) { return s.frame.frame_ms(); });
}

double TimeStatistics::fps() const {
    const double ms = time_row("", [](const FrameSample& s) { return s.interval_ms; }).median;
    return ms > 0 ? 1000 / ms : 0;
}

} // namespace catoptric::view
