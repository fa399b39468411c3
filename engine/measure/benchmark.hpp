#pragma once

#include "measure/comparison.hpp"
#include "measure/interval.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Benchmarks: what each round of them took, and what of two runs is slower.
namespace catoptric::measure {

/// What an iteration of one round took, on average.
struct BenchmarkRound {
    std::uint64_t iterations = 1;
    double real_ms = 0; ///< on the clock
    double cpu_ms = 0;  ///< processor time
    /// In user mode; none where the system does not count them.
    std::optional<double> cycles, instructions;
    std::map<std::string, double> counters; ///< whatever else there is to say, by name
};

struct Benchmark {
    std::string name;
    std::vector<BenchmarkRound> rounds;
};

/// What one run of a program measured, and where.
struct BenchmarkRun {
    std::string version, commit, date; ///< date: ISO 8601 with the offset from UTC
    std::vector<std::string> command;
    DeviceFacts device;        ///< of type "" where nothing is said of one
    int processors = 0;        ///< of the machine
    std::string uncounted;     ///< why cycles are not counted; empty: they are
    double load = 0;           ///< runnable threads of the machine when it began; NaN: not told
    std::optional<bool> noisy; ///< its threads had to wait for processors that others had
    std::vector<Benchmark> benchmarks;
};

/// What benchmarks are compared by.
enum class Cost { cycles, cpu_time, real_time };
/// "cycles", "processor time", "time"
std::string name_of(Cost cost);

/// A round's cost, cycles or milliseconds. NaN where the round has no cycles.
double cost_of(const BenchmarkRound& round, Cost cost);
/// Of all rounds, in order.
std::vector<double> costs_of(const Benchmark& benchmark, Cost cost);

/// A ratio of costs that were measured in rounds: the median of the rounds' ratios, and how far it
/// can be believed.
struct Ratio {
    double median = 0;
    Interval ci95; ///< unknown for fewer than `kFewest` rounds
    bool is_above_one() const { return ci95.low > 1; }
    bool is_below_one() const { return ci95.high < 1; }
};
/// a[i] / b[i], pair by pair; as many pairs as the shorter list has, at least one, else `internal`.
Ratio ratio_of(const std::vector<double>& a, const std::vector<double>& b);

/// One benchmark before and after.
struct Change {
    /// slower, faster: by its cost, and the clock does not say the opposite; mixed: it does. same:
    /// not told apart. unknown: too few rounds.
    enum class Outcome { slower, faster, mixed, same, unknown };
    std::string name;
    Cost cost = Cost::real_time;
    std::array<double, 2> medians{}; ///< of the cost, before and after
    Ratio ratio;                     ///< of the cost, after over before
    Ratio real_ratio;                ///< of the time on the clock
    Outcome outcome() const;
};
/// "slower", "faster", "mixed", "same", "unknown"
std::string name_of(Change::Outcome outcome);

struct Changes {
    std::vector<Change> list; ///< of what is in both, in the order of the later run
    std::vector<std::string> only_before, only_after;
};
/// By cycles where both runs counted them; else by processor time, since that repeats where others
/// are at work beside; by the clock where one of the runs has a device that is no processor.
Changes compare(const BenchmarkRun& before, const BenchmarkRun& after);

/// The rounds of both in one, in this order: what one of them lacks is left out. Its circumstances
/// are those of `first`.
BenchmarkRun joined(BenchmarkRun first, const BenchmarkRun& more);

} // namespace catoptric::measure
