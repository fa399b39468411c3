#pragma once

#include "measure/statistics.hpp"
#include "session/session.hpp"

#include <deque>
#include <string>
#include <vector>

namespace catoptric::view {

/// One line of the table of times, in milliseconds.
struct TimeRow {
    std::string name;
    double median = 0;
    measure::Interval ci95; ///< 95 % interval of the median; unknown below six frames
};

/// Times of the last frames. Starts again if the passes change.
class TimeStatistics {
public:
    static constexpr std::size_t kAveragedFrames = 60;

    /// Times of one frame. `host_ms` covers update, record and submit, measured by the host's
    /// clock. `interval_ms` is the time since the start of the previous frame.
    struct FrameSample {
        session::FrameTimes frame;
        double host_ms = 0, acquire_ms = 0, present_ms = 0, interval_ms = 0;
    };
    void add(FrameSample sample);
    std::size_t frame_count() const { return samples_.size(); }
    std::vector<TimeRow> list_pass_times() const;
    /// Returns the times of the host, parts first.
    std::vector<TimeRow> host() const;
    TimeRow gpu() const;
    TimeRow frame() const;
    /// Returns frames per second, from the median of the intervals; 0: unknown.
    double fps() const;

private:
    template <typename Get>
    TimeRow time_row(const std::string& name, const Get& get) const;

    std::deque<FrameSample> samples_;
};

} // namespace catoptric::view
