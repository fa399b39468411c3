#include "measure/audit_schedule.hpp"

#include "core/error.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::measure {

namespace {

constexpr std::size_t kFramesForMedian = 60, kFramesBeforeBlock = 8, kAuditsForTime = 4;
constexpr std::size_t kMaxBlock = 1'000'000; // frames; several hours
constexpr double kLongestFrame = 10;         // in medians; a longer frame counts as a pause of the
                                             // program

void keep_last(std::deque<double>& times, double ms, std::size_t most) {
    times.push_back(ms);
    if (times.size() > most) times.pop_front();
}

} // namespace

AuditSchedule::AuditSchedule(const AuditPace& pace) : pace_(pace), random_(pace.seed) {
    check(pace.every >= 1, Failure::usage, "audit: every: wanted at least 1 frame, found ",
          pace.every);
    check(pace.most_time > 0, Failure::usage,
          "audit: share of time: wanted a number above 0, found ", pace.most_time);
}

bool AuditSchedule::count_frame(double frame_ms) {
    const double usual_ms = last_frames_.empty() ? frame_ms : median_ms();
    const double counted_ms = std::min(frame_ms, kLongestFrame * usual_ms);
    if (was_audited_) { // the frame before was audited
        const double excess_ms = std::max(0.0, counted_ms - usual_ms);
        audits_ms_ += excess_ms, last_audits_.back() += excess_ms;
        frames_ms_ += counted_ms - excess_ms;
        was_audited_ = false;
    } else {
        frames_ms_ += counted_ms;
        keep_last(last_frames_, counted_ms, kFramesForMedian);
    }
    if (at_ == block_) {
        if (last_frames_.size() < kFramesBeforeBlock) return false;
        begin_block();
    }
    return at_++ == drawn_;
}

double AuditSchedule::median_ms() const {
    return percentile({last_frames_.begin(), last_frames_.end()}, .5);
}

void AuditSchedule::begin_block() {
    const double frame_ms = median_ms();
    const double audit_ms = last_audits_.empty() ? 0 : *std::ranges::max_element(last_audits_);
    double frames = pace_.every;
    if (audit_ms > 0) {
        const double needed = std::ceil(audit_ms / (pace_.most_time * frame_ms)); // inf: no time
        frames = std::clamp(needed, frames, std::max(frames, static_cast<double>(kMaxBlock)));
    }
    block_ = static_cast<std::size_t>(frames);
    at_ = 0, drawn_ = random_() % block_;
}

void AuditSchedule::expect_audit(double ms) { keep_last(last_audits_, ms, kAuditsForTime); }

void AuditSchedule::add_audit(double ms) {
    audits_ms_ += ms;
    expect_audit(ms);
    was_audited_ = true;
}

bool PlanLadder::step(double seconds) {
    constexpr double kSecondsBetweenSteps = .5;
    if (place_ == 0 || (stepped_ && seconds < *stepped_ + kSecondsBetweenSteps)) return false;
    --place_, stepped_ = seconds;
    return true;
}

} // namespace catoptric::measure
