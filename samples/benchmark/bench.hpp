#pragma once

#include "measure/benchmark.hpp"
#include "session/usage.hpp"
#include "session/watcher.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

/// Functions that measure benchmarks in rounds. Each round visits all benchmarks, so that a slow
/// moment of the machine affects all of them.
namespace catoptric::benchmark {

using namespace session;

/// Figures that one iteration reports. A round stores their mean.
struct IterationMeasurements {
    double host_ms = 0; ///< wall-clock time of the work that Subject::caller names
    std::map<std::string, double> counters;
};

/// Work that a benchmark repeats.
struct Subject {
    std::string name;
    std::function<IterationMeasurements()> work; ///< runs one iteration; its costs are measured
    int warmup = 1; ///< iterations before the first round, not measured
    /// Called after the warm-up and after each round. Its time is not measured. May be empty.
    std::function<void()> leave;
    /// Name of a second benchmark, which holds the work of the calling thread alone. Empty: none.
    std::string caller;
};

/// Makes a subject of work that reports no figures of its own.
Subject make_subject(std::string name, std::function<void()> work, int warmup = 1);

struct BenchOptions {
    /// Iterations of each subject over all rounds; frames_of_round distributes them.
    int iterations = 20;
    int rounds = 6; ///< at most one per iteration
    Watcher watcher;
};

/// Measures every subject in rounds, after all subjects have warmed up. Every second round visits
/// the subjects in reverse order. Takes as long as all iterations of the work. `meter`: counts the
/// whole process.
std::vector<measure::BenchmarkResult> measure_rounds(const std::vector<Subject>& subjects,
                                                     const UsageMeter& meter,
                                                     const BenchOptions& options);

/// Measures as measure_rounds does and adds the program's version, the device and the
/// circumstances. `command`: the program's command line.
measure::BenchmarkRun run_benchmarks(const std::vector<Subject>& subjects, const UsageMeter& meter,
                                     const BenchOptions& options,
                                     const measure::DeviceFacts& device,
                                     std::vector<std::string> command);

} // namespace catoptric::benchmark
