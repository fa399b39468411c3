#pragma once

#include "app/session.hpp"
#include "measure/statistics.hpp"

#include <deque>
#include <string>
#include <vector>

namespace catoptric::view {

/// One line of the table of times, milliseconds.
struct Line {
    std::string name;
    double median = 0;
    measure::Interval ci95; ///< of the median; not known below six frames
};

/// Times of the last frames; begins anew where their passes are others.
class Times {
public:
    static constexpr std::size_t kFrames = 60;

    /// `host_ms`: update, record and submit, as a clock beside them says; `interval_ms`: since the
    /// frame before was begun.
    struct Sample {
        app::FrameTimes frame;
        double host_ms = 0, acquire_ms = 0, present_ms = 0, interval_ms = 0;
    };
    void add(Sample sample);
    std::size_t count() const { return samples_.size(); }
    std::vector<Line> passes() const;
    /// What the host did, its parts first.
    std::vector<Line> host() const;
    Line gpu() const;
    Line frame() const;
    /// Frames a second, from the median of the intervals; 0: not known.
    double fps() const;

private:
    template <typename Get>
    Line line(const std::string& name, const Get& get) const;

    std::deque<Sample> samples_;
};

} // namespace catoptric::view
