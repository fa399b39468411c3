// Tests of choosing a technique for each mirror, against a search of all assignments.
#include "measure/plan_mix.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace catoptric::measure;

struct RandomMixProblem {
    std::vector<MixCandidate> candidates;
    std::vector<std::vector<double>> pixels;
    double limit = 0;
};

/// Returns random candidate techniques. Techniques that cost more usually have a smaller error.
RandomMixProblem draw_random_mix_problem(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const std::size_t mirrors = 1 + random() % 3, views = 1 + random() % 4;
    RandomMixProblem problem;
    for (std::size_t view = 0; view < views; ++view) {
        problem.pixels.emplace_back();
        for (std::size_t mirror = 0; mirror < mirrors; ++mirror)
            problem.pixels.back().push_back(std::floor(1000 * uniform(random)) + 1);
    }
    for (int i = 0; i < 4; ++i) {
        MixCandidate candidate{1 + 3.0 * i + uniform(random), {}};
        for (std::size_t view = 0; view < views; ++view) {
            candidate.error_sums.emplace_back();
            for (std::size_t mirror = 0; mirror < mirrors; ++mirror)
                candidate.error_sums.back().push_back(problem.pixels[view][mirror] * .4 *
                                                      uniform(random) / (1 + 2 * i));
        }
        problem.candidates.push_back(candidate);
    }
    problem.limit = .02 + .3 * uniform(random);
    return problem;
}

double largest_error(const RandomMixProblem& problem, const std::vector<std::size_t>& mix) {
    double largest = 0;
    for (std::size_t view = 0; view < problem.pixels.size(); ++view) {
        double error = 0, pixels = 0;
        for (std::size_t mirror = 0; mirror < mix.size(); ++mirror) {
            error += problem.candidates[mix[mirror]].error_sums[view][mirror];
            pixels += problem.pixels[view][mirror];
        }
        largest = std::max(largest, error / pixels);
    }
    return largest;
}

/// Returns the time of a mix: the sum of the times of each mirror's technique, weighted by the
/// mirror's share of the pixels.
double time_of_technique_mix(const RandomMixProblem& problem, const std::vector<std::size_t>& mix) {
    double ms = 0;
    for (const std::vector<double>& view : problem.pixels) {
        double pixels = 0;
        for (const double count : view) pixels += count;
        for (std::size_t mirror = 0; mirror < mix.size(); ++mirror)
            ms += problem.candidates[mix[mirror]].ms * view[mirror] / pixels;
    }
    return ms / static_cast<double>(problem.pixels.size());
}

TEST(PlanMix, KeepsTheLimitAndIsNearTheBestOfAllMixes) {
    int solved = 0, optimal = 0;
    double worst = 1;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        const RandomMixProblem problem = draw_random_mix_problem(seed);
        const std::vector<std::size_t> found = find_fastest_mix(problem.candidates, problem.pixels,
                                                                problem.limit);
        const std::size_t mirrors = problem.pixels.front().size();
        double best = INFINITY, best_alone = INFINITY;
        for (std::size_t code = 0; code < std::size_t{1} << (2 * mirrors); ++code) {
            std::vector<std::size_t> mix;
            for (std::size_t mirror = 0, rest = code; mirror < mirrors; ++mirror, rest /= 4)
                mix.push_back(rest % 4);
            if (largest_error(problem, mix) > problem.limit) continue;
            best = std::min(best, time_of_technique_mix(problem, mix));
            if (std::ranges::equal(mix, std::vector<std::size_t>(mirrors, mix.front())))
                best_alone = std::min(best_alone, time_of_technique_mix(problem, mix));
        }
        ASSERT_EQ(found.empty(), std::isinf(best_alone)) << seed;
        if (found.empty()) continue;
        ++solved;
        EXPECT_LE(largest_error(problem, found), problem.limit * (1 + 1e-12)) << seed;
        const double regret = time_of_technique_mix(problem, found) / best;
        EXPECT_LE(time_of_technique_mix(problem, found), best_alone * (1 + 1e-12)) << seed;
        worst = std::max(worst, regret);
        optimal += regret < 1 + 1e-9 ? 1 : 0;
    }
    EXPECT_GT(solved, 200);
    EXPECT_GE(optimal, .9 * solved);
    EXPECT_LE(worst, 2);
}

TEST(PlanMix, AnswersByHand) {
    const std::vector<std::vector<double>> pixels{{100, 0}};
    const std::vector<MixCandidate> candidates{{1, {{50, 0}}}, {5, {{1, 0}}}};
    EXPECT_EQ(find_fastest_mix(candidates, pixels, .1), (std::vector<std::size_t>{1, 1}));
    EXPECT_EQ(find_fastest_mix(candidates, pixels, .6), (std::vector<std::size_t>{0, 0}));
    EXPECT_TRUE(find_fastest_mix(candidates, pixels, .001).empty());
    EXPECT_TRUE(find_fastest_mix({}, pixels, 1).empty());
    EXPECT_TRUE(find_fastest_mix(candidates, {}, 1).empty());
}

} // namespace
