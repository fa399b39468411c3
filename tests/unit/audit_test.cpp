// Tests of the audit of running frames: known values of assurance and alarm, how often they are
// wrong, and how soon they notice a fault. Whether frames pass or fail is simulated.
#include "measure/audit.hpp"

#include "core/error.hpp"
#include "measure/audit_schedule.hpp"
#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

namespace {

using namespace catoptric;
using measure::Audit, measure::AuditSchedule, measure::PlanLadder;

using Outcomes = std::vector<char>; ///< for each frame, 1: the frame passed

Audit audit_of_outcomes(const Outcomes& passed, const measure::AuditedShare& tested = {}) {
    Audit audit(tested);
    for (const char pass : passed) audit.count_frame(pass != 0);
    return audit;
}

/// Returns the mean of the function `integrand` over (0, 1), by quadrature with 20,000 points.
template <typename Integrand>
double integrate_over_unit_interval(const Integrand& integrand) {
    constexpr int kPoints = 20'000;
    double sum = 0;
    for (int i = 0; i < kPoints; ++i) sum += integrand((i + .5) / kPoints);
    return sum / kPoints;
}

/// Returns the assurance value E of n frames that all passed, by its closed form.
double assurance_of_clean_frames(double share, double n) {
    return (1 - std::pow(share, n + 1)) / ((n + 1) * (1 - share) * std::pow(share, n));
}

std::size_t count_clean_frames_until_assured(const measure::AuditedShare& tested) {
    Audit audit(tested);
    while (!audit.is_assured()) audit.count_frame(true);
    return audit.frame_count();
}

TEST(Audit, CleanFramesAssureTheShareByTheClosedForm) {
    for (const double share : {.8, .9, .95, .99}) {
        Audit audit({.share = share});
        for (int n = 1; n <= 200; ++n) {
            audit.count_frame(true);
            const double known = assurance_of_clean_frames(share, n);
            EXPECT_NEAR(audit.assurance() / known, 1, n < 100 ? 1e-2 : .2) << share << " " << n;
        }
    }
    EXPECT_EQ(count_clean_frames_until_assured({}), 88u);
    EXPECT_EQ(count_clean_frames_until_assured({.share = .9}), 43u);
    EXPECT_EQ(count_clean_frames_until_assured({.share = .99}), 449u);
    EXPECT_LT(count_clean_frames_until_assured({.confidence = .9}), 88u);
    // With a mixture over all failing shares from 0 to 1, E would be 1 / ((n + 1) q^n), because
    // half of the mixture lies on the wrong side. This E reaches 20 only after 158 frames. No test
    // that is valid at all times needs fewer frames than the least n with q^n <= .05, which is 59.
    EXPECT_LT(1 / (158 * std::pow(.95, 157)), 20);
    EXPECT_GT(1 / (159 * std::pow(.95, 158)), 20);
}

TEST(Audit, EvidenceIsTheMixtureOfLikelihoodRatios) {
    for (const int failures : {0, 1, 4, 12}) {
        Outcomes passed(80, 1);
        for (int i = 0; i < failures; ++i) passed[static_cast<std::size_t>(5 * i)] = 0;
        const Audit audit = audit_of_outcomes(passed);
        const double known = integrate_over_unit_interval([&](double t) {
            return std::pow(t, failures) * std::pow((1 - .05 * t) / .95, 80 - failures);
        });
        EXPECT_NEAR(audit.assurance() / known, 1, 1e-2) << failures;
    }
    // The value of the alarm after a failure, a pass and a failure, computed from its definition.
    const Outcomes passed{0, 1, 0};
    double known = 1 / 4.; // the term that starts after the third frame
    for (std::size_t j = 0; j < 3; ++j)
        known += 1. / static_cast<double>((j + 1) * (j + 2)) *
                 integrate_over_unit_interval([&](double t) {
                     double ratio = 1;
                     for (std::size_t i = j; i < 3; ++i) {
                         const double u = .05 + .95 * t;
                         ratio *= passed[i] != 0 ? (1 - u) / .95 : u / .05;
                     }
                     return ratio;
                 });
    EXPECT_NEAR(audit_of_outcomes(passed).alarm_evidence() / known, 1, 1e-3);
}

TEST(Audit, AssuredShareIsWhereTheEvidenceReachesTheThreshold) {
    EXPECT_EQ(Audit().assured_share(), 0);
    EXPECT_EQ(audit_of_outcomes(Outcomes(20, 0)).assured_share(), 0);
    // 88 passing frames are the least number that assures a share of .95.
    EXPECT_LT(audit_of_outcomes(Outcomes(87, 1)).assured_share(), .95);
    EXPECT_NEAR(audit_of_outcomes(Outcomes(88, 1)).assured_share(), .95, 1e-3);
    double before = 0;
    Audit clean;
    for (int n = 0; n < 300; ++n) {
        for (int i = 0; i < 10; ++i) clean.count_frame(true);
        const double bound = clean.assured_share();
        EXPECT_GE(bound, before);
        before = bound;
    }
    EXPECT_GT(before, .995);
    EXPECT_LT(before, 1 - 3.0 / 3000); // a test of a fixed number of frames proves at least as much
    Outcomes some(200, 1);
    double last = audit_of_outcomes(some).assured_share();
    for (std::size_t i = 0; i < 20; ++i) { // turning a pass into a failure must lower the bound
        some[i] = 0;
        const double bound = audit_of_outcomes(some).assured_share();
        EXPECT_LT(bound, last);
        last = bound;
    }
}

TEST(Audit, AssuranceDoesNotDependOnTheOrderAndTheAlarmDoes) {
    Outcomes passed(120, 1);
    for (const std::size_t failed : {3, 40, 41, 90}) passed[failed] = 0;
    const Audit first = audit_of_outcomes(passed);
    std::mt19937_64 random(3);
    for (int i = 0; i < 10; ++i) {
        std::ranges::shuffle(passed, random);
        const Audit again = audit_of_outcomes(passed);
        EXPECT_EQ(again.assurance(), first.assurance());
        EXPECT_EQ(again.assured_share(), first.assured_share());
    }
    std::ranges::sort(passed); // all failures come first
    const double early = audit_of_outcomes(passed).alarm_evidence();
    std::ranges::reverse(passed); // all failures come last
    EXPECT_GT(audit_of_outcomes(passed).alarm_evidence(), 100 * early);
}

/// If the failing share is exactly 1 - q, the alarm may be raised in at most 5 % of all runs,
/// however long they are.
TEST(Audit, FalseAlarmsAndFalseAssurancesAreRareInLongRuns) {
    int alarms = 0, assurances = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 random(seed);
        std::bernoulli_distribution keeps(.95);
        Audit audit;
        bool is_ever_assured = false;
        for (int n = 0; n < 2000; ++n) {
            audit.count_frame(keeps(random));
            is_ever_assured = is_ever_assured || (n % 4 == 0 && audit.is_assured());
        }
        alarms += audit.is_alarmed(), assurances += is_ever_assured;
    }
    RecordProperty("false_alarms_of_200", alarms);
    RecordProperty("false_assurances_of_200", assurances);
    std::printf("false alarms %d, false assurances %d, of 200 runs of 2000 frames\n", alarms,
                assurances);
    EXPECT_LE(alarms, 10);
    EXPECT_LE(assurances, 10);
}

/// In this test the failing share changes along a run and depends on earlier frames. The assurance
/// must hold for the mean share so far. No alarm may be raised too often while the share stays at
/// most 1 - q.
TEST(Audit, ErrorRatesHoldForDependentFrames) {
    int alarms = 0, assurances = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> uniform;
        Audit calm, drifting;
        double sum = 0;
        bool is_wrong = false;
        for (int n = 1; n <= 1000; ++n) {
            // After a failure, frames fail with probability 5 %, and otherwise with a smaller
            // probability. The failing share therefore never exceeds the limit.
            calm.count_frame(uniform(random) >= (calm.failures() % 2 == 1 ? .05 : .03));
            const double failing = (n / 50) % 2 == 1 ? .1 : .0; // failing shares of .1 and 0 in
                                                                // turn, with the mean .05
            sum += failing;
            drifting.count_frame(uniform(random) >= failing);
            is_wrong = is_wrong || drifting.assurance_against(sum / n) >= 20;
        }
        alarms += calm.is_alarmed(), assurances += is_wrong;
    }
    EXPECT_LE(alarms, 10);
    EXPECT_LE(assurances, 10);
}

/// Returns the numbers of frames from the beginning of a fault until the alarm, for 20 seeds,
/// sorted. Before the fault, `before` frames fail with the probability `usual`.
std::vector<int> count_frames_until_alarm(int before, double usual, double failing) {
    std::vector<int> delays;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> uniform;
        Audit audit;
        for (int n = 0; n < before; ++n) audit.count_frame(uniform(random) >= usual);
        EXPECT_FALSE(audit.is_alarmed()) << seed;
        int delay = 0;
        while (!audit.is_alarmed() && delay < 500)
            audit.count_frame(uniform(random) >= failing), ++delay;
        delays.push_back(delay);
    }
    std::ranges::sort(delays);
    return delays;
}

TEST(Audit, FaultsAreNoticedInEveryRun) {
    const struct {
        int before;
        double usual, failing;
        int most; ///< audited frames until the slowest of 20 alarms
    } faults[] = {{0, 0, 1, 2},   {100, 0, 1, 5},   {1000, 0, 1, 7},     {1000, .02, 1, 8},
                  {0, 0, .5, 25}, {100, 0, .5, 30}, {1000, .02, .5, 40}, {1000, .02, .25, 150}};
    for (const auto& [before, usual, failing, most] : faults) {
        const std::vector<int> delays = count_frames_until_alarm(before, usual, failing);
        std::printf(
            "after %4d frames (%.2f fail), a fault that fails %.2f: alarm after %d, at most "
            "%d frames\n",
            before, usual, failing, delays[10], delays.back());
        EXPECT_LE(delays.back(), most) << before << " " << failing;
    }
}

TEST(Audit, AlarmStaysAndLongRunsStayFinite) {
    Audit audit;
    audit.count_frame(false);
    EXPECT_FALSE(audit.is_alarmed()); // one failing frame must not raise an alarm
    audit.count_frame(false);
    EXPECT_TRUE(audit.is_alarmed());
    for (int n = 0; n < 5000; ++n) audit.count_frame(true);
    EXPECT_TRUE(audit.is_alarmed());
    EXPECT_LT(audit.alarm_evidence(), 20);
    for (int n = 0; n < 5000; ++n) audit.count_frame(false);
    EXPECT_TRUE(std::isfinite(audit.alarm_evidence()));
    EXPECT_EQ(audit.assurance() < 1, true);
    EXPECT_EQ(audit.frame_count(), 10'002u);
    EXPECT_EQ(audit.failures(), 5'002u);
}

TEST(Audit, SharesOutOfRangeAreRefused) {
    EXPECT_EQ(test::catch_error_text(Failure::usage, [] { Audit({.share = 1}); }),
              "audit: share: wanted a number above 0 and at most 0.9999, found 1");
    EXPECT_EQ(test::catch_error_text(Failure::usage, [] { Audit({.confidence = 0}); }),
              "audit: confidence: wanted a number above 0 and at most 0.9999, found 0");
    EXPECT_EQ(test::catch_error_text(Failure::usage, [] { Audit({.share = NAN}); }),
              "audit: share: wanted a number above 0 and at most 0.9999, found nan");
    EXPECT_EQ(test::catch_error_text(Failure::usage, [] { AuditSchedule({.every = 0}); }),
              "audit: every: wanted at least 1 frame, found 0");
    EXPECT_EQ(test::catch_error_text(Failure::usage, [] { AuditSchedule({.most_time = 0}); }),
              "audit: share of time: wanted a number above 0, found 0");
}

/// Returns the numbers, from 0, of the frames that a schedule audits.
std::vector<int> list_audited_frames(AuditSchedule& schedule, int frames, double frame_ms,
                                     double audit_ms) {
    std::vector<int> audited;
    for (int k = 0; k < frames; ++k)
        if (schedule.count_frame(frame_ms)) audited.push_back(k), schedule.add_audit(audit_ms);
    return audited;
}

TEST(AuditSchedule, DrawsOneFrameOfEachBlock) {
    AuditSchedule schedule({.every = 10});
    const std::vector<int> audited = list_audited_frames(schedule, 7 + 10 * 200, 10, .1);
    ASSERT_EQ(audited.size(), 200u);
    std::set<int> places;
    for (int i = 0; i < 200; ++i) {
        const int place = audited[static_cast<std::size_t>(i)] - 7 -
                          10 * i; // 7 frames do not count
        EXPECT_GE(place, 0);
        EXPECT_LT(place, 10);
        places.insert(place);
    }
    EXPECT_EQ(places.size(), 10u); // all ten positions of a block are drawn
    AuditSchedule other({.every = 10, .seed = 2}), same({.every = 10});
    EXPECT_NE(list_audited_frames(other, 2007, 10, .1), audited);
    EXPECT_EQ(list_audited_frames(same, 2007, 10, .1), audited);
}

TEST(AuditSchedule, KeepsTheLimitOfTime) {
    for (const double audit_ms : {1., 10., 100., 1000.}) {
        AuditSchedule schedule({.every = 60});
        schedule.expect_audit(audit_ms);
        list_audited_frames(schedule, 20'000, 2, audit_ms);
        EXPECT_LE(schedule.audits_ms(), 1.01 * .05 * schedule.frames_ms() + audit_ms) << audit_ms;
        EXPECT_GE(schedule.audits_ms(), audit_ms); // audits become rarer but do not stop
        const double least = audit_ms / (.05 * 2);
        EXPECT_EQ(schedule.block_length(), static_cast<std::size_t>(std::max(60., least)));
    }
    // If frames become slower, audits take a smaller share of the time and may be more frequent.
    AuditSchedule schedule({.every = 10});
    schedule.expect_audit(10);
    list_audited_frames(schedule, 1000, 1, 10);
    EXPECT_EQ(schedule.block_length(), 200u);
    list_audited_frames(schedule, 1000, 20, 10);
    EXPECT_EQ(schedule.block_length(), 10u);
}

TEST(AuditSchedule, CountsWhatTheNextFrameTakesLonger) {
    AuditSchedule schedule({.every = 1, .most_time = 1});
    for (int k = 0; k < 7; ++k) EXPECT_FALSE(schedule.count_frame(2));
    EXPECT_TRUE(schedule.count_frame(2));
    schedule.add_audit(4);
    schedule.count_frame(5); // 3 ms longer than the median frame
    EXPECT_EQ(schedule.audits_ms(), 7);
    EXPECT_EQ(schedule.frames_ms(), 18);
    schedule.count_frame(5); // no audit preceded this frame
    EXPECT_EQ(schedule.audits_ms(), 7);
    EXPECT_EQ(schedule.frames_ms(), 23);
    schedule.count_frame(1000); // a long frame means a pause of the program
    EXPECT_EQ(schedule.frames_ms(), 43);
}

TEST(PlanLadder, StepsToTheSurerSideAtMostTwiceASecond) {
    PlanLadder ladder(100);
    EXPECT_EQ(ladder.place(), 99u);
    std::vector<double> steps;
    for (int i = 0; i < 1000; ++i)
        if (const double seconds = .01 * i; ladder.step(seconds)) steps.push_back(seconds);
    EXPECT_EQ(ladder.place(), 99 - steps.size());
    ASSERT_GE(steps.size(), 19u);
    for (std::size_t i = 2; i < steps.size(); ++i) EXPECT_GE(steps[i] - steps[i - 2], 1 - 1e-9);
    PlanLadder two(2);
    EXPECT_TRUE(two.step(0));
    EXPECT_FALSE(two.step(10)); // the plan is already the one with the least error
    EXPECT_EQ(two.place(), 0u);
}

} // namespace
