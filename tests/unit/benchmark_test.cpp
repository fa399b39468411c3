// Tests of comparing two benchmark runs (faster, slower or unknown) and of benchmark files.
#include "report/benchmarks.hpp"

#include "core/error.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <functional>

namespace {

using namespace catoptric;
using measure::BenchmarkChange;
using measure::BenchmarkResult;
using measure::BenchmarkRound;
using measure::BenchmarkRun;
using measure::CostKind;
using Outcome = BenchmarkChange::Outcome;
using nlohmann::json;

/// Builds a benchmark with one round for each value of `ms`. The value is both the wall-clock time
/// and the processor time of the round.
BenchmarkResult make_benchmark(const std::string& name, const std::vector<double>& ms) {
    BenchmarkResult made{name, {}};
    for (const double value : ms) {
        BenchmarkRound round;
        round.iterations = 3, round.real_ms = value, round.cpu_ms = value;
        made.rounds.push_back(round);
    }
    return made;
}

BenchmarkRun make_benchmark_run(std::vector<BenchmarkResult> list) {
    BenchmarkRun run;
    run.device.type = "cpu";
    run.benchmarks = std::move(list);
    return run;
}

const std::vector<double> kSixBenchmarkTimes{10, 11, 12, 13, 14, 15};

std::vector<double> make_benchmark_times(double factor) {
    std::vector<double> values = kSixBenchmarkTimes;
    for (double& value : values) value *= factor;
    return values;
}

BenchmarkChange compare_runs_of_one_benchmark(const BenchmarkRun& before,
                                              const BenchmarkRun& after) {
    return measure::compare_runs(before, after).list.at(0);
}

TEST(BenchmarkCompare, RatioIsTheMedianOfTheRatiosOfRounds) {
    // The ratios of the rounds are 1.5, 1, 1, 1, 1 and 3, with median 1. The ratio of the two
    // medians would be 20 / 15.
    const BenchmarkChange found = compare_runs_of_one_benchmark(
        make_benchmark_run({make_benchmark("a", {10, 10, 20, 20, 30, 10})}),
        make_benchmark_run({make_benchmark("a", {15, 10, 20, 20, 30, 30})}));
    EXPECT_EQ(found.ratio.median, 1);
    EXPECT_EQ(found.ratio.ci95.low, 1);
    EXPECT_EQ(found.ratio.ci95.high, 3);
    EXPECT_EQ(found.medians, (std::array{15.0, 20.0}));
    EXPECT_EQ(found.outcome(), Outcome::same);
}

TEST(BenchmarkCompare, RunsDifferIfTheRatioIntervalExcludesOne) {
    const auto outcome = [](double factor) {
        return compare_runs_of_one_benchmark(
                   make_benchmark_run({make_benchmark("a", kSixBenchmarkTimes)}),
                   make_benchmark_run({make_benchmark("a", make_benchmark_times(factor))}))
            .outcome();
    };
    EXPECT_EQ(outcome(1.01), Outcome::slower);
    EXPECT_EQ(outcome(1), Outcome::same);
    EXPECT_EQ(outcome(.99), Outcome::faster);
}

TEST(BenchmarkCompare, FewerThanSixRoundsGiveAnUnknownOutcome) {
    const std::vector<double> five{1, 1, 1, 1, 1}, double_of_it{2, 2, 2, 2, 2};
    EXPECT_EQ(compare_runs_of_one_benchmark(make_benchmark_run({make_benchmark("a", five)}),
                                            make_benchmark_run({make_benchmark("a", double_of_it)}))
                  .outcome(),
              Outcome::unknown);
}

TEST(BenchmarkCompare, CyclesAreComparedIfBothRunsCountedThem) {
    BenchmarkResult counted = make_benchmark("a", kSixBenchmarkTimes),
                    more = make_benchmark("a", make_benchmark_times(.5));
    for (BenchmarkRound& round : counted.rounds) round.cycles = 1e6;
    for (BenchmarkRound& round : more.rounds) round.cycles = 2e6;
    const BenchmarkChange found = compare_runs_of_one_benchmark(make_benchmark_run({counted}),
                                                                make_benchmark_run({more}));
    EXPECT_EQ(found.cost, CostKind::cycles);
    EXPECT_EQ(found.ratio.median, 2);
    EXPECT_EQ(found.outcome(), Outcome::mixed) << "twice the cycles in half the time";
    more.rounds[3].cycles.reset();
    EXPECT_EQ(
        compare_runs_of_one_benchmark(make_benchmark_run({counted}), make_benchmark_run({more}))
            .cost,
        CostKind::cpu_time);
}

TEST(BenchmarkCompare, InstructionsAreComparedIfCyclesAreNotCounted) {
    BenchmarkResult counted = make_benchmark("a", kSixBenchmarkTimes),
                    more = make_benchmark("a", kSixBenchmarkTimes);
    for (BenchmarkRound& round : counted.rounds) round.instructions = 1e6;
    for (BenchmarkRound& round : more.rounds) round.instructions = 3e6;
    const BenchmarkChange found = compare_runs_of_one_benchmark(make_benchmark_run({counted}),
                                                                make_benchmark_run({more}));
    EXPECT_EQ(found.cost, CostKind::instructions);
    EXPECT_EQ(found.ratio.median, 3);
}

TEST(BenchmarkCompare, CountedWorkIsComparedWithoutAClock) {
    BenchmarkResult before = make_benchmark("a", kSixBenchmarkTimes),
                    after = make_benchmark("a", kSixBenchmarkTimes);
    for (BenchmarkRound& round : before.rounds)
        round.counters = {{"work/nodes", 1000}, {"work/draws", 7}, {"work/bytes", 5}, {"rays", 1}};
    for (BenchmarkRound& round : after.rounds)
        round.counters = {{"work/nodes", 1011}, {"work/draws", 7}, {"work/bytes", 4}, {"rays", 9}};
    const BenchmarkChange found = compare_runs_of_one_benchmark(make_benchmark_run({before}),
                                                                make_benchmark_run({after}));
    EXPECT_EQ(found.outcome(), Outcome::same);
    EXPECT_EQ(found.compared_counts, 3u);
    ASSERT_EQ(found.counts.size(), 2u);
    EXPECT_EQ(found.counts[0].name, "work/bytes");
    EXPECT_FALSE(found.counts[0].has_grown());
    EXPECT_EQ(found.counts[1].name, "work/nodes");
    EXPECT_EQ(found.counts[1].after, 1011);
    EXPECT_TRUE(found.counts[1].has_grown());
    EXPECT_FALSE((measure::WorkChange{"work/nodes", 1000, 1010}).has_grown());
}

TEST(BenchmarkCompare, MoreProcessorTimeInLessWallTimeIsMixed) {
    BenchmarkResult shared = make_benchmark("a", make_benchmark_times(1.1));
    for (BenchmarkRound& round : shared.rounds) round.real_ms /= 2;
    EXPECT_EQ(
        compare_runs_of_one_benchmark(make_benchmark_run({make_benchmark("a", kSixBenchmarkTimes)}),
                                      make_benchmark_run({shared}))
            .outcome(),
        Outcome::mixed);
}

TEST(BenchmarkCompare, WallTimeIsComparedIfTheDeviceIsNoProcessor) {
    BenchmarkRun gpu = make_benchmark_run({make_benchmark("a", kSixBenchmarkTimes)});
    gpu.device.type = "discrete";
    EXPECT_EQ(compare_runs_of_one_benchmark(
                  make_benchmark_run({make_benchmark("a", kSixBenchmarkTimes)}), gpu)
                  .cost,
              CostKind::real_time);
}

TEST(BenchmarkCompare, BenchmarksOfOnlyOneRunAreListed) {
    const measure::BenchmarkChanges found = measure::compare_runs(
        make_benchmark_run({make_benchmark("gone", kSixBenchmarkTimes),
                            make_benchmark("both", kSixBenchmarkTimes)}),
        make_benchmark_run({make_benchmark("both", kSixBenchmarkTimes),
                            make_benchmark("new", kSixBenchmarkTimes)}));
    ASSERT_EQ(found.list.size(), 1U);
    EXPECT_THAT(found.only_before, testing::ElementsAre("gone"));
    EXPECT_THAT(found.only_after, testing::ElementsAre("new"));
}

TEST(BenchmarkJoin, JoinedRunsAppendRoundsAndDropUnmatchedBenchmarks) {
    const BenchmarkRun both = measure::join_runs(
        make_benchmark_run({make_benchmark("a", {1, 2}), make_benchmark("b", {5})}),
        make_benchmark_run({make_benchmark("a", {3})}));
    ASSERT_EQ(both.benchmarks.size(), 1U);
    EXPECT_EQ(round_costs(both.benchmarks[0], CostKind::real_time), (std::vector{1.0, 2.0, 3.0}));
}

TEST(BenchmarkFile, FileFollowsTheGoogleBenchmarkFormat) {
    BenchmarkRun run = make_benchmark_run({make_benchmark("frame/x", kSixBenchmarkTimes)});
    run.benchmarks[0].rounds[0].cycles = 5e6;
    run.benchmarks[0].rounds[0].counters["rays"] = 508289;
    run.uncounted = "nobody knows";
    const json document = json::parse(report::to_json(run));
    EXPECT_EQ(document["context"]["schema"], "catoptric/bench/1");
    EXPECT_EQ(document["context"]["cycles"], "not counted: nobody knows");
    ASSERT_EQ(document["benchmarks"].size(), 7U);
    const json& first = document["benchmarks"][0];
    EXPECT_EQ(first["name"], "frame/x");
    EXPECT_EQ(first["run_name"], "frame/x");
    EXPECT_EQ(first["run_type"], "iteration");
    EXPECT_EQ(first["repetitions"], 6);
    EXPECT_EQ(first["repetition_index"], 0);
    EXPECT_EQ(first["iterations"], 3);
    EXPECT_EQ(first["real_time"], 10);
    EXPECT_EQ(first["cpu_time"], 10);
    EXPECT_EQ(first["time_unit"], "ms");
    EXPECT_EQ(first["cycles"], 5000000);
    EXPECT_EQ(first["rays"], 508289);
    EXPECT_FALSE(document["benchmarks"][1].contains("cycles"));
    const json& median = document["benchmarks"][6];
    EXPECT_EQ(median["name"], "frame/x_median");
    EXPECT_EQ(median["run_type"], "aggregate");
    EXPECT_EQ(median["aggregate_name"], "median");
    EXPECT_EQ(median["real_time"], 12.5);
    EXPECT_EQ(median["real_time_ci95"], (json{10, 15}));
}

TEST(BenchmarkFile, WrittenRunIsReadBackUnchanged) {
    BenchmarkRun run = make_benchmark_run(
        {make_benchmark("a", kSixBenchmarkTimes), make_benchmark("b", {1.5})});
    run.commit = "abc", run.device.name = "llvmpipe", run.noisy = true;
    run.benchmarks[1].rounds[0].cycles = 7, run.benchmarks[1].rounds[0].instructions = 9;
    run.benchmarks[1].rounds[0].counters["gpu_ms"] = .25;
    const std::string text = report::to_json(run);
    const BenchmarkRun read = report::read_benchmarks(text, "run.json");
    EXPECT_EQ(read.commit, "abc");
    EXPECT_EQ(read.device.name, "llvmpipe");
    EXPECT_EQ(read.noisy, true);
    ASSERT_EQ(read.benchmarks.size(), 2U);
    EXPECT_EQ(round_costs(read.benchmarks[0], CostKind::cpu_time), kSixBenchmarkTimes);
    const BenchmarkRound& round = read.benchmarks[1].rounds.at(0);
    EXPECT_EQ(round.iterations, 3U);
    EXPECT_EQ(round.cycles, 7);
    EXPECT_EQ(round.instructions, 9);
    EXPECT_EQ(round.counters, (std::map<std::string, double>{{"gpu_ms", .25}}));
}

/// The file is in the form that Google Benchmark writes: times in ns and us, an aggregate entry and
/// an entry of a failed benchmark.
TEST(BenchmarkFile, FileOfGoogleBenchmarkIsRead) {
    const BenchmarkRun read = report::read_benchmarks(
        R"({"context": {"num_cpus": 2}, "benchmarks": [
        {"name": "plan/34", "run_name": "plan/34", "run_type": "iteration", "iterations": 9,
         "real_time": 2.5e4, "cpu_time": 2.0e4, "time_unit": "ns", "a pass": 1.5},
        {"name": "plan/34_mean", "run_name": "plan/34", "run_type": "aggregate", "real_time": 1,
         "cpu_time": 1, "time_unit": "ns"},
        {"name": "broken", "run_type": "iteration", "error_occurred": true, "error_message": "x"},
        {"name": "old", "real_time": 3, "cpu_time": 2, "time_unit": "us"}]})",
        "theirs.json");
    ASSERT_EQ(read.benchmarks.size(), 2U);
    ASSERT_EQ(read.benchmarks[0].rounds.size(), 1U);
    EXPECT_DOUBLE_EQ(read.benchmarks[0].rounds[0].real_ms, .025);
    EXPECT_DOUBLE_EQ(read.benchmarks[0].rounds[0].cpu_ms, .02);
    EXPECT_EQ(read.benchmarks[0].rounds[0].counters.at("a pass"), 1.5);
    EXPECT_EQ(read.benchmarks[1].name, "old");
    EXPECT_DOUBLE_EQ(read.benchmarks[1].rounds[0].real_ms, .003);
}

TEST(BenchmarkFile, ErrorsNamePlaceExpectedAndFound) {
    const auto entry = [](const std::string& members) {
        return R"({"benchmarks": [{"name": "a", "real_time": 1, "cpu_time": 1, "time_unit": "ms"}, )" +
               members + "]}";
    };
    const std::pair<std::string, std::string> cases[] = {
        {"{", "x.json: JSON: line 1, column 2: wanted a key"},
        {"[1]", "x.json: wanted an object with a list 'benchmarks', as 'catoptric bench --json' "
                "writes it, found a list"},
        {R"({"rows": []})", "found benchmarks: nothing"},
        {R"({"benchmarks": []})",
         "x.json: benchmarks: wanted at least one that was measured, found "
         "none among 0 entries"},
        {entry("3"), "x.json: benchmarks[1]: wanted an object, found '3'"},
        {entry("{}"), "x.json: benchmarks[1].name: wanted text, found nothing"},
        {entry(R"({"name": "b", "time_unit": "h"})"),
         "x.json: benchmarks[1].time_unit: wanted ns, us, ms or s, found 'h'"},
        {entry(R"({"name": "b", "time_unit": "s", "real_time": "fast"})"),
         "x.json: benchmarks[1].real_time: wanted a number of at least 0, found '\"fast\"'"},
        {entry(R"({"name": "b", "time_unit": "s", "real_time": 1, "cpu_time": -1})"),
         "x.json: benchmarks[1].cpu_time: wanted a number of at least 0, found '-1'"},
        {entry(R"({"name": "b", "time_unit": "s", "real_time": 1, "cpu_time": 1, "cycles": []})"),
         "x.json: benchmarks[1].cycles: wanted a number of at least 0, found a list"}};
    for (const auto& [text, message] : cases) {
        try {
            report::read_benchmarks(text, "x.json");
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::bad_data);
            EXPECT_THAT(error.what(), testing::HasSubstr(message));
        }
    }
}

TEST(BenchmarkChanges, ComparisonIsWrittenAsJson) {
    const json document = json::parse(report::to_json(measure::compare_runs(
        make_benchmark_run({make_benchmark("a", kSixBenchmarkTimes), make_benchmark("b", {1})}),
        make_benchmark_run(
            {make_benchmark("a", make_benchmark_times(2)), make_benchmark("c", {1})}))));
    EXPECT_EQ(document["schema"], "catoptric/bench-compare/1");
    ASSERT_EQ(document["benchmarks"].size(), 1U);
    const json& row = document["benchmarks"][0];
    EXPECT_EQ(row["name"], "a");
    EXPECT_EQ(row["cost"], "processor time");
    EXPECT_EQ(row["before"], 12.5);
    EXPECT_EQ(row["after"], 25);
    EXPECT_EQ(row["ratio"]["median"], 2);
    EXPECT_EQ(row["ratio"]["ci95"], (json{2, 2}));
    EXPECT_EQ(row["outcome"], "slower");
    EXPECT_EQ(document["only_before"], json{"b"});
    EXPECT_EQ(document["only_after"], json{"c"});
}

} // namespace
