#pragma once

#include "app/usage.hpp"
#include "app/watcher.hpp"
#include "measure/benchmark.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

/// Measuring benchmarks in rounds, so that what slows the machine down for a while slows them all.
namespace catoptric::app {

/// What an iteration says of itself, averaged over a round's.
struct Iteration {
    double host_ms = 0; ///< of Subject::caller: time on the clock
    std::map<std::string, double> counters;
};

/// What is done again and again.
struct Subject {
    std::string name;
    std::function<Iteration()> work; ///< one iteration; what it takes is measured
    int warmup = 1;                  ///< iterations before the first round, not measured
    std::function<void()> leave;     ///< after the warm-up and each round, not measured; or none
    /// Name of a benchmark of its own: what the calling thread alone did for it. Empty: none.
    std::string caller;
};

/// Of work that says nothing of itself.
Subject subject_of(std::string name, std::function<void()> work, int warmup = 1);

struct BenchOptions {
    int iterations = 20; ///< of each subject in all rounds, shared out as frames_of_round does
    int rounds = 6;      ///< at most one an iteration
    Watcher watcher;
};

/// Every subject's rounds: all warm up, then each round goes through them, there and back. Costs
/// what the work does. `meter`: of the process.
std::vector<measure::Benchmark> measure_rounds(const std::vector<Subject>& subjects,
                                               const UsageMeter& meter,
                                               const BenchOptions& options);

/// The same as a run of this program: version, device and circumstances. `command`: its line.
measure::BenchmarkRun bench(const std::vector<Subject>& subjects, const UsageMeter& meter,
                            const BenchOptions& options, const measure::DeviceFacts& device,
                            std::vector<std::string> command);

} // namespace catoptric::app
