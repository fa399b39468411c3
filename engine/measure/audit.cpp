#include "measure/audit.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace catoptric::measure {

namespace {

/// Returns the middle of the i-th of `count` equal parts of the interval from 0 to 1.
double midpoint(std::size_t i, std::size_t count) {
    return (static_cast<double>(i) + .5) / static_cast<double>(count);
}

} // namespace

Audit::Audit(const AuditedShare& tested) : tested_(tested) {
    constexpr double kMaxPart = .9999;
    for (const auto& [name, value] :
         {std::pair{"share", tested.share}, std::pair{"confidence", tested.confidence}})
        check(value > 0 && value <= kMaxPart, Failure::usage, "audit: ", name,
              ": wanted a number above 0 and at most ", kMaxPart, ", found ", value);
}

void Audit::count_frame(bool passed) {
    ++frames_;
    failures_ += passed ? 0 : 1;
    const double start = static_cast<double>(frames_), bad = 1 - tested_.share;
    for (std::size_t i = 0; i < kAlternatives; ++i) {
        const double u = bad + tested_.share * midpoint(i, kAlternatives);
        const double ratio = passed ? (1 - u) / tested_.share : u / bad;
        constexpr double kLargest = 1e100; // far above any threshold; a sum that is cut off here
                                           // stays valid
        ratios_[i] = std::min(kLargest, ratio * (ratios_[i] + 1 / (start * (start + 1))));
    }
    // One failing frame alone never raises an alarm, however small the allowed share of failures
    // is. Waiting for a second failure only delays an alarm.
    is_alarmed_ = is_alarmed_ || (failures_ >= 2 && alarm_evidence() >= threshold());
}

double Audit::alarm_evidence() const {
    const double later_starts = 1 / static_cast<double>(frames_ + 1);
    return later_starts + std::accumulate(ratios_.begin(), ratios_.end(), 0.0) / kAlternatives;
}

double Audit::assurance_against(double failing_share) const {
    const double n = static_cast<double>(frames_), k = static_cast<double>(failures_);
    const double bad = 1 - tested_.share;
    double sum = 0;
    for (std::size_t i = 0; i < kAlternatives; ++i) {
        const double t = midpoint(i, kAlternatives);
        const double w = t * (1 - bad) / (1 - t * bad);
        sum += std::exp(k * std::log(w) - n * std::log1p(failing_share * (w - 1)));
    }
    return sum / kAlternatives;
}

double Audit::assured_share() const {
    if (assurance_against(1) < threshold()) return 0;
    constexpr int kSteps = 50; // halvings of an interval of length 1
    double low = 0, high = 1;  // bounds: excluded failing shares lie above, others below
    for (int i = 0; i < kSteps; ++i) {
        const double middle = (low + high) / 2;
        (assurance_against(middle) >= threshold() ? high : low) = middle;
    }
    return 1 - high;
}

} // namespace catoptric::measure
