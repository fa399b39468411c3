#include "benchmark/bench.hpp"

#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "session/engine.hpp"
#include "session/processor.hpp"
#include "session/watcher.hpp"
#include "study/row_run.hpp"

#include <ctime>
#include <set>
#include <thread>
#include <utility>

namespace catoptric::benchmark {

namespace {

using measure::BenchmarkResult;
using measure::BenchmarkRound;

/// Sums of measured costs over the iterations of one round.
struct RoundSums {
    double real_ms = 0, host_ms = 0;
    ProcessorUsage process, caller;
    std::map<std::string, double> counters;

    void add_iteration(const IterationMeasurements& iteration) {
        host_ms += iteration.host_ms;
        for (const auto& [name, value] : iteration.counters) counters[name] += value;
    }
};

BenchmarkRound divide_by_iterations(int iterations, double real_ms, const ProcessorUsage& usage) {
    const double count = iterations;
    const auto each = [&](const std::optional<double>& sum) {
        return sum ? std::optional(*sum / count) : std::nullopt;
    };
    return {.iterations = static_cast<std::uint64_t>(iterations),
            .real_ms = real_ms / count,
            .cpu_ms = usage.cpu_ms / count,
            .cycles = each(usage.cycles),
            .instructions = each(usage.instructions),
            .counters = {}};
}

class BenchmarkRunner {
public:
    BenchmarkRunner(const std::vector<Subject>& subjects, const UsageMeter& meter,
                    const BenchOptions& options)
        : subjects_(subjects), meter_(meter), options_(options),
          rounds_(study::round_count(options.iterations, options.rounds)) {
        std::set<std::string> names;
        for (const Subject& subject : subjects) {
            check(names.insert(subject.name).second, Failure::usage, "benchmark '", subject.name,
                  "' is asked for twice");
            list_.push_back({subject.name, {}});
            callers_.push_back({subject.caller, {}});
        }
    }

    std::vector<BenchmarkResult> run() {
        for (std::size_t i = 0; i < subjects_.size(); ++i) warm_up(i);
        const PinnedThreads held;
        for (int round = 0; round < rounds_; ++round)
            for (std::size_t place = 0; place < subjects_.size(); ++place)
                // Every second round visits the subjects in reverse order. The same subject then
                // never always comes before another, whose measurement its remaining work could
                // disturb.
                measure_round(round % 2 == 0 ? place : subjects_.size() - 1 - place, round);
        for (BenchmarkResult& caller : callers_)
            if (!caller.name.empty()) list_.push_back(std::move(caller));
        return std::move(list_);
    }

private:
    void report_progress(std::size_t index, const std::string& doing) const {
        const std::size_t steps = subjects_.size() * (static_cast<std::size_t>(rounds_) + 1);
        report_row(options_.watcher, subjects_[index].name + doing, done_, steps);
    }

    void report_finished(const Subject& subject) {
        if (subject.leave) subject.leave();
        ++done_;
    }

    void warm_up(std::size_t index) {
        const Subject& subject = subjects_[index];
        report_progress(index, ", warm-up");
        for (int k = 1; k <= subject.warmup; ++k) {
            subject.work();
            report_frame(options_.watcher, k, subject.warmup);
        }
        report_finished(subject);
    }

    void measure_round(std::size_t index, int round) {
        const Subject& subject = subjects_[index];
        report_progress(index,
                        ", round " + std::to_string(round + 1) + " of " + std::to_string(rounds_));
        const int iterations = study::frames_of_round(options_.iterations, rounds_, round);
        RoundSums sums;
        const ProcessorUsage process = meter_.read(), caller = caller_meter_.read();
        {
            const Stopwatch watch(sums.real_ms);
            for (int k = 0; k < iterations; ++k) sums.add_iteration(subject.work());
        }
        sums.caller = caller_meter_.read() - caller, sums.process = meter_.read() - process;
        store_round(index, iterations, sums);
        report_finished(subject);
        report_frame(options_.watcher, iterations, iterations);
    }

    void store_round(std::size_t index, int iterations, const RoundSums& sums) {
        BenchmarkRound round = divide_by_iterations(iterations, sums.real_ms, sums.process);
        for (const auto& [name, sum] : sums.counters) round.counters[name] = sum / iterations;
        list_[index].rounds.push_back(std::move(round));
        callers_[index].rounds.push_back(
            divide_by_iterations(iterations, sums.host_ms, sums.caller));
    }

    const std::vector<Subject>& subjects_;
    const UsageMeter& meter_;
    const UsageMeter caller_meter_{UsageMeter::Threads::caller};
    const BenchOptions& options_;
    int rounds_;
    std::size_t done_ = 0;
    std::vector<BenchmarkResult> list_, callers_;
};

std::string format_current_date() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    ::localtime_r(&now, &local);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%FT%T%z", &local)};
}

} // namespace

Subject make_subject(std::string name, std::function<void()> work, int warmup) {
    return {.name = std::move(name),
            .work =
                [work = std::move(work)] {
                    work();
                    return IterationMeasurements();
                },
            .warmup = warmup,
            .leave = {},
            .caller = {}};
}

std::vector<measure::BenchmarkResult> measure_rounds(const std::vector<Subject>& subjects,
                                                     const UsageMeter& meter,
                                                     const BenchOptions& options) {
    return BenchmarkRunner(subjects, meter, options).run();
}

measure::BenchmarkRun run_benchmarks(const std::vector<Subject>& subjects, const UsageMeter& meter,
                                     const BenchOptions& options,
                                     const measure::DeviceFacts& device,
                                     std::vector<std::string> command) {
    const WatchedWork watched(options.watcher);
    measure::BenchmarkRun run;
    run.version = version(), run.commit = commit(), run.date = format_current_date();
    run.command = std::move(command);
    run.device = device;
    run.processors = static_cast<int>(std::thread::hardware_concurrency());
    run.uncounted = meter.why_uncounted();
    run.load = read_machine_load();
    const std::optional<ProcessorTimes> before = read_processor_times();
    run.benchmarks = measure_rounds(subjects, meter, options);
    if (const std::optional<ProcessorTimes> after = read_processor_times(); before && after)
        run.noisy = is_timing_noisy(waiting_share(waiting_times(*before, *after)));
    return run;
}

} // namespace catoptric::benchmark
