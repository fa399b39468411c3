#pragma once

#include <array>
#include <cstddef>

// Sequential tests of the statement "the share of a program's frames that keep a limit is at least
// q". The tests may be read after every audited frame, for as long as the program runs.
namespace catoptric::measure {

/// The statement that an audit tests.
struct AuditedShare {
    double share = .95;      ///< q, of the frames that must keep the limit, between 0 and 1
    double confidence = .95; ///< 1 - d; each test errs with probability d at most, over all time
};

/// Counts audited frames and tests two statements about the share of failing frames, f.
///
/// With a = 1 - q, k failures among n audited frames, and f_i the probability that audited frame i
/// fails given the frames before it:
/// - Assurance, E(a) = mean over t of w^k / (1 + a (w - 1))^n, with w = t (1 - a) / (1 - t a). It
///   is a mixture of likelihood ratios of the failing shares t a below a against a, where t is
///   uniform in (0, 1). As long as the mean of f_1 ... f_n is at least a, it is at most a
///   nonnegative martingale that starts at 1. By Ville's inequality E(a) >= 1/d at any n with
///   probability d at most. Without a failure E(a) = (1 - q^(n+1)) / ((n + 1) (1 - q) q^n).
/// - Alarm, A = sum over j of 1 / (j (j + 1)) times the mean over u of the likelihood ratio of
///   frames j to n of the failing share u above a against a, u uniform in (a, 1); starts j after n
///   count as 1. If each f_i is at most a, it is a nonnegative supermartingale that starts at 1,
///   and A >= 1/d at any n with probability d at most. Frames before a fault weigh little, because
///   the terms of later starts do not count them.
/// No independence of the frames is assumed. The integrals over t and u are means of 64 values,
/// which are mixtures too, and keep the bounds exactly.
/// Sources: Robbins, Statistical Methods Related to the Law of the Iterated Logarithm, 1970 (the
/// mixture); Howard, Ramdas, McAuliffe, Sekhon, Time-uniform, nonparametric, nonasymptotic
/// confidence sequences, 2021; Shin, Ramdas, Rinaldo, E-detectors, 2024 (the mixture over starts).
class Audit {
public:
    /// Throws `usage` unless both numbers lie between 0 and 1, .9999 at most.
    explicit Audit(const AuditedShare& tested = {});

    /// Costs some hundred operations.
    void count_frame(bool passed);

    std::size_t frame_count() const { return frames_; }
    std::size_t failures() const { return failures_; }
    /// Returns E(a), the evidence that the frames' mean probability of failing is below a.
    /// `failing_share`: a, from 0 to 1. The result does not depend on the order of the frames. The
    /// mixture over t is the one for the tested q, whatever a is.
    double assurance_against(double failing_share) const;
    double assurance() const { return assurance_against(1 - tested_.share); } ///< E(1 - q)
    bool is_assured() const { return assurance() >= threshold(); }
    /// Returns the largest assured share: 1 - a for the least a with E(a) >= 1/d; 0 if no share is
    /// assured. With probability 1 - d, the frames' mean probability of passing is above this share
    /// after every frame.
    double assured_share() const;
    /// Returns A, the evidence for an alarm. A depends on the order of the frames.
    double alarm_evidence() const;
    /// Returns whether A has reached 1/d after any frame since the second failure.
    bool is_alarmed() const { return is_alarmed_; }

private:
    static constexpr std::size_t kAlternatives = 64; ///< values of t and u

    double threshold() const { return 1 / (1 - tested_.confidence); }

    AuditedShare tested_;
    std::size_t frames_ = 0, failures_ = 0;
    /// For each value of u, the sum of the weighted likelihood ratios over all starts j <= n.
    std::array<double, kAlternatives> ratios_{};
    bool is_alarmed_ = false;
};

} // namespace catoptric::measure
