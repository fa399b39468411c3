#include "times.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <algorithm>

namespace catoptric::view {

namespace {

bool have_equal_passes(const app::FrameTimes& a, const app::FrameTimes& b) {
    return std::ranges::equal(a.passes, b.passes, {}, &app::PassTime::name, &app::PassTime::name);
}

} // namespace

void TimeStatistics::add(FrameTimeSample sample) {
    if (!samples_.empty() && !have_equal_passes(samples_.back().frame, sample.frame))
        samples_.clear();
    samples_.push_back(std::move(sample));
    if (samples_.size() > kFrames) samples_.pop_front();
}

template <typename Get>
TimeRow TimeStatistics::line(const std::string& name, const Get& get) const {
    std::vector<double> values;
    for (const FrameTimeSample& sample : samples_) values.push_back(get(sample));
    if (values.empty()) return {name, 0, {}};
    return {name, measure::compute_percentile(values, .5), measure::median_interval(values)};
}

std::vector<TimeRow> TimeStatistics::passes() const {
    std::vector<TimeRow> lines;
    for (std::size_t i = 0; !samples_.empty() && i < samples_.back().frame.passes.size(); ++i)
        lines.push_back(line(samples_.back().frame.passes[i].name,
                             [i](const FrameTimeSample& s) { return s.frame.passes[i].ms(); }));
    return lines;
}

std::vector<TimeRow> TimeStatistics::host() const {
    return {line("update", [](const FrameTimeSample& s) { return s.frame.host.update; }),
            line("hierarchy", [](const FrameTimeSample& s) { return s.frame.host.hierarchy; }),
            line("compile", [](const FrameTimeSample& s) { return s.frame.host.compile; }),
            line("record", [](const FrameTimeSample& s) { return s.frame.host.record; }),
            line("host, by the clock", [](const FrameTimeSample& s) { return s.host_ms; }),
            line("acquire", [](const FrameTimeSample& s) { return s.acquire_ms; }),
            line("present", [](const FrameTimeSample& s) { return s.present_ms; })};
}

TimeRow TimeStatistics::gpu() const {
    return line("gpu", [](const FrameTimeSample& s) { return s.frame.gpu_ms; });
}

TimeRow TimeStatistics::frame() const {
    return line("frame", [](const FrameTimeSample& s) { return s.frame.frame_ms(); });
}

double TimeStatistics::fps() const {
    const double ms = line("", [](const FrameTimeSample& s) { return s.interval_ms; }).median;
    return ms > 0 ? 1000 / ms : 0;
}

} // namespace catoptric::view
