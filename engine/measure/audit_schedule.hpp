#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <random>

// Classes that choose which frames of a running program are audited, and when its plan may change.
namespace catoptric::measure {

struct AuditPace {
    int every = 60;         ///< least number of frames in a block, from 1
    double most_time = .05; ///< limit of the audits' time, as a share of the frames' time
    std::uint64_t seed = 1; ///< seed of the random choice of audited frames
};

/// Draws one frame at random from each block of successive frames. The draw makes the outcome of an
/// audit a fair sample of the block, however its frames depend on each other, and whatever their
/// period. A block has `every` frames, or as many more as keep the limit of time: the largest of
/// the last 4 audits' times over `most_time` times the median time of the last 60 frames.
class AuditSchedule {
public:
    /// Throws `usage` for numbers out of range.
    explicit AuditSchedule(const AuditPace& pace = {});

    /// Counts one frame, which took `frame_ms` without an audit. Returns whether to audit this
    /// frame. If the previous frame was audited, the time by which this frame exceeds the median
    /// counts as time of the audit. A frame of more than 10 medians counts as 10 medians, because
    /// the program has paused.
    bool count_frame(double frame_ms);
    /// Adds the time of an audit to the audits' time of the run.
    void add_audit(double ms);
    /// Reports how long an audit takes, before the first frame. This time helps to choose the
    /// length of blocks, but is not part of the run.
    void expect_audit(double ms);

    /// Returns the number of frames of the present block; 0 before the first.
    std::size_t block_length() const { return block_; }
    double frames_ms() const { return frames_ms_; } ///< all frames without their audits
    double audits_ms() const { return audits_ms_; }

private:
    double median_ms() const;
    void begin_block();

    AuditPace pace_;
    std::mt19937_64 random_;
    std::deque<double> last_frames_, last_audits_; ///< ms
    std::size_t block_ = 0, at_ = 0;               ///< frames of the block: all, so far
    std::size_t drawn_ = 0;                        ///< index of the audited frame in its block,
                                                   ///< from 0
    double frames_ms_ = 0, audits_ms_ = 0;
    bool was_audited_ = false; ///< whether the frame before was audited
};

/// The current position in a list of plans, which is sorted from the plan with the least error to
/// the cheapest. The position only moves towards plans with less error, and at most twice in any
/// second.
class PlanLadder {
public:
    /// `plans`: at least 1.
    explicit PlanLadder(std::size_t plans) : place_(plans - 1) {}
    std::size_t place() const { return place_; } ///< index of the present plan
    /// Moves to the next plan with less error. Returns false if there is none, or within half a
    /// second of the last step. `seconds`: time since any fixed beginning; it must never fall.
    bool step(double seconds);

private:
    std::size_t place_;
    std::optional<double> stepped_; ///< time of the last step
};

} // namespace catoptric::measure
