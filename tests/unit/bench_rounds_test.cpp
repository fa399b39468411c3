// Tests of how benchmarks are measured: the order in which benchmarks take turns, and the processor
// usage that is counted.
#include "benchmark/bench.hpp"

#include "core/error.hpp"

#include <gmock/gmock.h>

#include <ctime>
#include <thread>

namespace {

using namespace catoptric;
using benchmark::Subject;
using session::UsageMeter;

/// Builds a benchmark that logs `letter` for each iteration and '|' at the end of each turn.
Subject make_logging_benchmark(char letter, std::string& log, int warmup = 1) {
    return {.name = std::string(1, letter),
            .work =
                [letter, &log] {
                    log += letter;
                    return benchmark::IterationMeasurements{
                        2, {{"length", static_cast<double>(log.size())}}};
                },
            .warmup = warmup,
            .leave = [&log] { log += '|'; },
            .caller = letter == 'a' ? "caller of a" : ""};
}

TEST(BenchRounds, BenchmarksTakeTurnsForwardsThenBackwardsAfterWarmUp) {
    std::string log;
    const UsageMeter meter(UsageMeter::Threads::process);
    const std::vector<Subject> subjects{make_logging_benchmark('a', log, 2),
                                        make_logging_benchmark('b', log),
                                        make_logging_benchmark('c', log, 0)};
    benchmark::measure_rounds(subjects, meter, {.iterations = 5, .rounds = 3, .watcher = {}});
    EXPECT_EQ(log, "aa|b||"
                   "aa|bb|cc|"
                   "cc|bb|aa|"
                   "a|b|c|");
}

TEST(BenchRounds, RoundsKeepIterationsCountersAndCallerTime) {
    std::string log;
    const UsageMeter meter(UsageMeter::Threads::process);
    const std::vector<Subject> subjects{make_logging_benchmark('a', log, 0),
                                        make_logging_benchmark('b', log, 0)};
    const std::vector<measure::BenchmarkResult> found = benchmark::measure_rounds(
        subjects, meter, {.iterations = 3, .rounds = 2, .watcher = {}});
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].name, "a");
    EXPECT_EQ(found[1].name, "b");
    EXPECT_EQ(found[2].name, "caller of a");
    ASSERT_EQ(found[0].rounds.size(), 2U);
    EXPECT_EQ(found[0].rounds[0].iterations, 2U);
    EXPECT_EQ(found[0].rounds[1].iterations, 1U);
    // The log has "||" of the warm-ups, then "a" and "aa". The counter is the mean of lengths 3 and
    // 4.
    EXPECT_EQ(found[0].rounds[0].counters.at("length"), 3.5);
    EXPECT_EQ(found[2].rounds[0].real_ms, 2);
}

TEST(BenchRounds, RoundsAreAtMostIterationsAndRepeatedNamesAreRefused) {
    std::string log;
    const UsageMeter meter(UsageMeter::Threads::process);
    EXPECT_EQ(benchmark::measure_rounds({make_logging_benchmark('b', log)}, meter,
                                        {.iterations = 2, .rounds = 6, .watcher = {}})[0]
                  .rounds.size(),
              2U);
    try {
        benchmark::measure_rounds(
            {make_logging_benchmark('b', log), make_logging_benchmark('b', log)}, meter, {});
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::usage);
        EXPECT_STREQ(error.what(), "benchmark 'b' is asked for twice");
    }
}

double thread_processor_ms() {
    timespec used{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return 1e3 * static_cast<double>(used.tv_sec) + 1e-6 * static_cast<double>(used.tv_nsec);
}

/// Processor time of another thread counts for the process, but not for the calling thread.
TEST(UsageMeter, ProcessUsageIncludesOtherThreads) {
    const UsageMeter process(UsageMeter::Threads::process), caller(UsageMeter::Threads::caller);
    const double caller_before = thread_processor_ms();
    const session::ProcessorUsage all = process.read(), own = caller.read();
    double worked_ms = 0;
    std::thread([&worked_ms] {
        while ((worked_ms = thread_processor_ms()) < 5) {
        }
    }).join();
    const session::ProcessorUsage own_after = caller.read() - own, all_after = process.read() - all;
    EXPECT_GE(all_after.cpu_ms, worked_ms);
    EXPECT_LE(own_after.cpu_ms, thread_processor_ms() - caller_before + 1e-9)
        << "but for roundings";
    EXPECT_EQ(all_after.cycles.has_value(), process.why_uncounted().empty());
    if (process.why_uncounted().empty()) {
        EXPECT_GT(*all_after.cycles, *own_after.cycles);
        EXPECT_GT(*all_after.instructions, *own_after.instructions);
    } else {
        EXPECT_THAT(process.why_uncounted(), testing::StartsWith("perf_event_open: "));
    }
}

} // namespace
