#include "bench_table.hpp"

#include "core/text.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"
#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::cli {

namespace {

using measure::Benchmark;
using measure::BenchmarkRun;
using measure::Change;
using measure::Cost;

using Cells = std::vector<std::vector<std::string>>;

std::string benchmark_figure(double value) { return fmt::format("{:.3f}", value); }

/// Adds the median and its interval, in `unit`.
void add(std::vector<std::string>& cells, const std::vector<double>& values, double unit = 1) {
    cells.push_back(benchmark_figure(measure::percentile(values, .5) / unit));
    cells.push_back(interval_text(measure::median_interval(values), unit));
}

std::vector<std::string> cells_of(const Benchmark& benchmark, bool counted) {
    std::vector<std::string> cells{printable(benchmark.name)};
    add(cells, costs_of(benchmark, Cost::real_time));
    add(cells, costs_of(benchmark, Cost::cpu_time));
    if (!counted) return cells;
    add(cells, costs_of(benchmark, Cost::cycles), 1e6);
    std::vector<double> instructions;
    for (const measure::BenchmarkRound& round : benchmark.rounds)
        instructions.push_back(round.instructions.value_or(0));
    cells.push_back(benchmark_figure(measure::percentile(instructions, .5) / 1e6));
    return cells;
}

/// Returns a cost as text, in millions of cycles or in milliseconds.
std::string cost_text(double cost, Cost of) {
    return benchmark_figure(of == Cost::cycles ? cost / 1e6 : cost);
}

/// Returns the kinds of cost that the list compares.
std::string costs_text(const measure::Changes& changes) {
    std::string text;
    for (const Cost cost : {Cost::cycles, Cost::cpu_time, Cost::real_time})
        if (std::ranges::find(changes.list, cost, &Change::cost) != changes.list.end())
            text += (text.empty() ? "" : " or ") + name_of(cost) +
                    (cost == Cost::cycles ? " in user mode, millions" : ", ms");
    return text;
}

std::string list_text(const char* title, const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + printable(name);
    return names.empty() ? "" : fmt::format("{}: {}\n", title, text);
}

} // namespace

std::string interval_text(const measure::Interval& interval, double unit) {
    if (!interval.is_known()) return "-";
    return fmt::format("[{:.3f} - {:.3f}]", interval.low / unit, interval.high / unit);
}

std::string bench_table(const BenchmarkRun& run) {
    const bool counted = run.uncounted.empty();
    Cells cells{{"benchmark", "ms", "[95 %]", "cpu ms", "[95 %]"}};
    if (counted)
        for (const char* title : {"Mcycles", "[95 %]", "Minstr"}) cells.front().emplace_back(title);
    std::size_t rounds = 0;
    for (const Benchmark& benchmark : run.benchmarks) {
        rounds = std::max(rounds, benchmark.rounds.size());
        cells.push_back(cells_of(benchmark, counted));
    }
    const std::string caution =
        run.noisy.value_or(false)
            ? "noisy: threads had to wait for processors that others had; times are not to be "
              "trusted\n"
            : "";
    return caution +
           fmt::format("{}; medians of {} rounds; {}\n", run.device.name, rounds,
                       counted ? "cycles and instructions in user mode of all threads"
                               : "cycles are not counted (" + run.uncounted +
                                     "), processor time takes their place") +
           aligned(cells);
}

std::string changes_table(const measure::Changes& changes) {
    Cells cells{{"benchmark", "before", "after", "ratio", "[95 %]", "ms ratio", "[95 %]", ""}};
    for (const Change& change : changes.list)
        cells.push_back({printable(change.name), cost_text(change.medians[0], change.cost),
                         cost_text(change.medians[1], change.cost),
                         benchmark_figure(change.ratio.median), interval_text(change.ratio.ci95),
                         benchmark_figure(change.real_ratio.median),
                         interval_text(change.real_ratio.ci95), name_of(change.outcome())});
    return (changes.list.empty()
                ? "nothing is in both\n"
                : "compared by " + costs_text(changes) + "\n" + aligned(cells, 7)) +
           list_text("only before", changes.only_before) +
           list_text("only after", changes.only_after);
}

std::string slower_text(const measure::Changes& changes) {
    std::string text;
    for (const Change& change : changes.list)
        if (change.outcome() == Change::Outcome::slower)
            text += fmt::format("{}{} {:.3f} {}", text.empty() ? "" : ", ", change.name,
                                change.ratio.median, interval_text(change.ratio.ci95));
    return text;
}

} // namespace catoptric::cli
