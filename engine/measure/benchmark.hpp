#pragma once

#include "measure/comparison.hpp"
#include "measure/interval.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Types and functions for benchmarks: the costs of each round, and the comparison of two runs.
namespace catoptric::measure {

/// Mean cost of one iteration of a round.
struct BenchmarkRound {
    std::uint64_t iterations = 1;
    double real_ms = 0; ///< elapsed time, ms
    double cpu_ms = 0;  ///< processor time, ms
    /// Processor cycles and instructions in user mode. Empty if the system does not count them.
    std::optional<double> cycles, instructions;
    std::map<std::string, double> counters; ///< further values of the benchmark, by name
};

struct BenchmarkResult {
    std::string name;
    std::vector<BenchmarkRound> rounds;
};

/// Measurements of one run of a program, and the circumstances of the run.
struct BenchmarkRun {
    std::string version, commit, date; ///< date: ISO 8601 with the offset from UTC
    std::vector<std::string> command;
    DeviceFacts device;    ///< an empty `type` means that the run names no device
    int processors = 0;    ///< number of the machine's processors
    std::string uncounted; ///< reason why cycles are not counted; empty if they are
    double load = 0;       ///< the machine's runnable threads at the start; NaN if unknown
    /// Whether the run's threads waited for processors that other programs used.
    std::optional<bool> noisy;
    std::vector<BenchmarkResult> benchmarks;
};

/// The cost by which benchmarks are compared.
enum class CostKind { cycles, instructions, cpu_time, real_time };
/// Returns "cycles", "instructions", "processor time" or "time".
std::string cost_kind_name(CostKind cost);

/// Returns a round's cost in cycles, instructions or milliseconds. Returns NaN if the round has no
/// cycles or no instructions.
double cost_of(const BenchmarkRound& round, CostKind cost);
/// Returns the costs of all rounds, in order.
std::vector<double> round_costs(const BenchmarkResult& benchmark, CostKind cost);

/// Ratio of costs that were measured in rounds: the median of the rounds' ratios, and its
/// confidence interval.
struct CostRatio {
    double median = 0;
    Interval ci95; ///< 95 % confidence; unknown for fewer than `kMinIntervalSamples` rounds
    bool is_above_one() const { return ci95.low > 1; }
    bool is_below_one() const { return ci95.high < 1; }
};
/// Returns the ratio a[i] / b[i] over as many pairs as the shorter list has. Throws `internal`
/// without a pair.
CostRatio cost_ratio(const std::vector<double>& a, const std::vector<double>& b);

/// Beginning of the names of counters that hold counted work (core/work.hpp), such as "work/nodes".
inline constexpr const char* kWorkPrefix = "work/";

/// Counted work of a benchmark that differs before and after a change.
struct WorkChange {
    std::string name; ///< name of the counter
    double before = 0, after = 0;
    /// Returns whether the work has grown by more than a hundredth. Counts have no noise, so no
    /// clock is needed to tell.
    bool has_grown() const { return after > 1.01 * before; }
};

/// Costs of one benchmark before and after a change.
struct BenchmarkChange {
    /// Result of the comparison. `slower` and `faster`: the cost says so and the elapsed time does
    /// not say the opposite. `mixed`: the elapsed time says the opposite. `same`: the two cannot be
    /// told apart. `unknown`: there are too few rounds.
    enum class Outcome { slower, faster, mixed, same, unknown };
    std::string name;
    CostKind cost = CostKind::real_time;
    std::array<double, 2> medians{}; ///< medians of the cost, before and after
    CostRatio ratio;                 ///< cost after, divided by cost before
    CostRatio real_ratio;            ///< ratio of the elapsed times
    std::size_t compared_counts = 0; ///< number of counts of work that both runs have
    std::vector<WorkChange> counts;  ///< counts that differ
    Outcome outcome() const;
};
std::string outcome_name(BenchmarkChange::Outcome outcome);

struct BenchmarkChanges {
    std::vector<BenchmarkChange>
        list; ///< the benchmarks of both runs, in the order of the later run
    std::vector<std::string> only_before, only_after;
};
/// Compares the benchmarks that both runs contain. The cost is cycles if both runs counted them,
/// or else instructions if both counted those. Otherwise the cost is processor time, because it
/// repeats even if other programs run at the same time. Counted work is compared in any case. If a
/// run's device is not a processor, the cost is elapsed time.
BenchmarkChanges compare_runs(const BenchmarkRun& before, const BenchmarkRun& after);

/// Returns one run with the rounds of `first` followed by those of `more`. Benchmarks that `more`
/// lacks are left out. The circumstances are those of `first`, but noise in either run is kept.
BenchmarkRun join_runs(BenchmarkRun first, const BenchmarkRun& more);

} // namespace catoptric::measure
