// Tests of the decision which plans a choice proves, and in which order.
#include "measure/proof_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace {

using namespace catoptric;

TEST(ProbabilityOfProof, FollowsTablesOfStudentsDistribution) {
    struct Case {
        std::vector<double> logarithms; ///< of the errors; their mean is 0
        double t;                       ///< exceeded with probability .025
    };
    const std::vector<Case> cases = {{{-1, 1}, 12.706}, // 1 degree of freedom
                                     {{-1, 0, 1}, 4.303},
                                     {{-1, -1, 1, 1}, 3.182},
                                     {{-2, -1, 0, 1, 2}, 2.776},
                                     {{-2, -2, -1, -1, 0, 0, 0, 1, 1, 2, 2, 0}, 2.201}};
    for (const Case& tested : cases) {
        const double count = static_cast<double>(tested.logarithms.size());
        std::vector<double> errors;
        double squares = 0;
        for (const double value : tested.logarithms) {
            errors.push_back(.01 * std::exp(.05 * value));
            squares += .0025 * value * value;
        }
        const double deviation = std::sqrt(squares / (count - 1) * (1 + 1 / count)),
                     limit = .01 * std::exp(tested.t * deviation),
                     opposite = .01 * std::exp(-tested.t * deviation);
        EXPECT_NEAR(measure::proof_probability(errors, limit, 1, 0, 0), .975, 2e-5);
        EXPECT_NEAR(measure::proof_probability(errors, opposite, 1, 0, 0), .025, 2e-5);
        EXPECT_NEAR(measure::proof_probability(errors, .01, 1, 0, 0), .5, 1e-9);
        EXPECT_NEAR(measure::proof_probability(errors, .01, 3, 1, 0), .5, 1e-9);
        EXPECT_NEAR(measure::proof_probability(errors, limit, 10, 0, 0), std::pow(.975, 10), 2e-4);
    }
}

TEST(ProbabilityOfProof, IsTheShareOfFurtherValuesBelowTheLimit) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(-3, .3);
    constexpr int kDraws = 40000;
    double estimated = 0, kept = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
        std::vector<double> errors;
        for (int i = 0; i < 8; ++i) errors.push_back(std::exp(normal(random)));
        // The limit lies 2.5 deviations of these errors' logarithms above their mean.
        double mean = 0, squares = 0;
        for (const double error : errors) mean += std::log(error) / 8;
        for (const double error : errors) squares += std::pow(std::log(error) - mean, 2) / 7;
        const double limit = std::exp(mean + 2.5 * std::sqrt(squares));
        estimated += measure::proof_probability(errors, limit, 1, 0, 0) / kDraws;
        kept += (std::exp(normal(random)) <= limit ? 1. : 0.) / kDraws;
    }
    EXPECT_NEAR(estimated, kept, .004); // the standard error of `kept` is below .001
}

TEST(ProbabilityOfProof, ViewsWithoutAnErrorDoNotMakeAProofUnlikely) {
    for (const std::size_t zeros : {1, 3, 6, 11})
        for (const double share : {.001, .02, .1}) {
            std::vector<double> errors(12, share * .05);
            std::fill_n(errors.begin(), zeros, 0.);
            EXPECT_GT(measure::proof_probability(errors, .05, 59, 0, .5), .75)
                << zeros << ' ' << share;
        }
}

TEST(ProbabilityOfProof, ExtremesHaveCertainAnswers) {
    const std::vector<double> equal(6, .02), none(6, 0.), with_infinity{.01, .02, INFINITY};
    EXPECT_EQ(measure::proof_probability(equal, .03, 59, 0, 0), 1);
    EXPECT_EQ(measure::proof_probability(equal, .01, 59, 0, 0), 0);
    EXPECT_EQ(measure::proof_probability(none, .01, 59, 0, 0), 1);
    EXPECT_EQ(measure::proof_probability(none, 0, 59, 0, 0), 1);
    EXPECT_EQ(measure::proof_probability(equal, 0, 59, 0, 0), 0);
    EXPECT_EQ(measure::proof_probability(with_infinity, .03, 59, 0, 0), 0);
    EXPECT_EQ(measure::proof_probability(std::vector{.01}, .03, 59, 0, 0), 0);
}

/// Returns the expected logarithm of the chosen plan's time if these plans are proved in turn.
double expected_log_time(const std::vector<measure::ProofCandidate>& candidates,
                         const std::vector<std::size_t>& order, double no_plan) {
    double expected = 0, reached = 1, before = std::log(no_plan);
    for (const std::size_t plan : order) {
        expected += reached * (1 - candidates[plan].probability) * before;
        reached *= candidates[plan].probability;
        before = std::log(candidates[plan].ms);
    }
    return expected + reached * before;
}

TEST(ProbabilityOfProof, AddedDeviationActsLikeSpreadErrors) {
    // Logarithms with a deviation of .3, or of 0 and .3 added.
    const std::vector<double> equal(3, .01), spread{.01 * std::exp(-.3), .01, .01 * std::exp(.3)};
    for (const double limit : {.011, .02, .05})
        EXPECT_NEAR(measure::proof_probability(equal, limit, 59, 0, .3),
                    measure::proof_probability(spread, limit, 59, 0, 0), 1e-12);
    EXPECT_LT(measure::proof_probability(equal, .02, 59, 0, .3), .1);
}

TEST(ProofOrder, HasTheLeastExpectedLogarithmOfTime) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 300; ++round) {
        std::vector<measure::ProofCandidate> candidates(1 + random() % 7);
        for (measure::ProofCandidate& plan : candidates)
            plan = {std::exp(4 * unit(random)), random() % 8 == 0 ? 1 : unit(random)};
        const std::size_t most = 1 + random() % 4;
        const double slowest = std::ranges::max(candidates, {}, &measure::ProofCandidate::ms).ms;
        double least = std::log(10 * slowest);
        for (unsigned set = 1; set < 1u << candidates.size(); ++set) {
            if (static_cast<std::size_t>(std::popcount(set)) > most) continue;
            std::vector<std::size_t> order;
            for (std::size_t i = 0; i < candidates.size(); ++i)
                if (set >> i & 1) order.push_back(i);
            std::ranges::sort(order, std::greater{},
                              [&](std::size_t i) { return candidates[i].ms; });
            least = std::min(least, expected_log_time(candidates, order, 10 * slowest));
        }
        const std::vector<std::size_t> order = measure::find_best_order(candidates, most, 10);
        ASSERT_LE(order.size(), most);
        EXPECT_NEAR(expected_log_time(candidates, order, 10 * slowest), least, 1e-9) << round;
    }
}

TEST(ProofOrder, LeavesOutAPlanWhoseProofIsLikelyToFail) {
    // The second plan saves little, and its failure would forbid the third, which is likely to
    // hold.
    const std::vector<measure::ProofCandidate> candidates{{100, 1}, {90, .5}, {10, .95}};
    EXPECT_EQ(measure::find_best_order(candidates, 4, 10), (std::vector<std::size_t>{0, 2}));
}

TEST(ProofOrder, TinyProbabilitiesStillOrderPlans) {
    const std::vector<measure::ProofCandidate> candidates{{100, 1e-24}, {10, 1e-25}, {9, 1e-40}};
    EXPECT_EQ(measure::find_best_order(candidates, 4, 10), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(ProofOrder, IsEmptyIfNoProofCanSucceed) {
    EXPECT_TRUE(measure::find_best_order({}, 4, 10).empty());
    const std::vector<measure::ProofCandidate> hopeless{{5, 0}, {3, 0}};
    EXPECT_TRUE(measure::find_best_order(hopeless, 4, 10).empty());
}

} // namespace
