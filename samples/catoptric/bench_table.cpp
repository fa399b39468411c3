#include "bench_table.hpp"

#include "core/text.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"
#include "table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::cli {

namespace {

using measure::BenchmarkChange;
using measure::BenchmarkResult;
using measure::BenchmarkRun;
using measure::CostKind;

using BenchmarkTableCells = std::vector<std::vector<std::string>>;

std::string format_number(double value) { return fmt::format("{:.3f}", value); }

/// Adds the median and its interval, in `unit`.
void add_median_cells(std::vector<std::string>& cells, const std::vector<double>& values,
                      double unit = 1) {
    cells.push_back(format_number(measure::percentile(values, .5) / unit));
    cells.push_back(format_interval(measure::median_interval(values), unit));
}

std::vector<std::string> benchmark_cells(const BenchmarkResult& benchmark, bool counted) {
    std::vector<std::string> cells{escape(benchmark.name)};
    add_median_cells(cells, round_costs(benchmark, CostKind::real_time));
    add_median_cells(cells, round_costs(benchmark, CostKind::cpu_time));
    if (!counted) return cells;
    add_median_cells(cells, round_costs(benchmark, CostKind::cycles), 1e6);
    std::vector<double> instructions;
    for (const measure::BenchmarkRound& round : benchmark.rounds)
        instructions.push_back(round.instructions.value_or(0));
    cells.push_back(format_number(measure::percentile(instructions, .5) / 1e6));
    return cells;
}

bool is_counted(CostKind cost) {
    return cost == CostKind::cycles || cost == CostKind::instructions;
}

/// Returns a cost as text, in millions of cycles or instructions, or in milliseconds.
std::string format_cost(double cost, CostKind of) {
    return format_number(is_counted(of) ? cost / 1e6 : cost);
}

/// Returns the kinds of cost (cycles, time) that a comparison of two measurements covers, as text.
std::string cost_kinds(const measure::BenchmarkChanges& changes) {
    std::string text;
    for (const CostKind cost :
         {CostKind::cycles, CostKind::instructions, CostKind::cpu_time, CostKind::real_time})
        if (std::ranges::find(changes.list, cost, &BenchmarkChange::cost) != changes.list.end())
            text += (text.empty() ? "" : " or ") + cost_kind_name(cost) +
                    (is_counted(cost) ? " in user mode, millions" : ", ms");
    return text;
}

/// Returns a line for each count of work that differs between two measurements, or a sentence if
/// none differs.
std::string format_count_changes(const measure::BenchmarkChanges& changes) {
    std::size_t compared = 0;
    BenchmarkTableCells cells{{"counted work", "count", "before", "after", "ratio"}};
    for (const BenchmarkChange& change : changes.list) {
        compared += change.compared_counts;
        for (const measure::WorkChange& count : change.counts)
            cells.push_back(
                {escape(change.name), escape(count.name), fmt::format("{:.0f}", count.before),
                 fmt::format("{:.0f}", count.after),
                 count.before > 0 ? fmt::format("{:.4f}", count.after / count.before) : "-"});
    }
    if (cells.size() > 1) return align_columns(cells);
    return compared == 0 ? "" : fmt::format("counted work: all {} counts are equal\n", compared);
}

std::string format_name_list(const char* title, const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + escape(name);
    return names.empty() ? "" : fmt::format("{}: {}\n", title, text);
}

} // namespace

std::string format_interval(const measure::Interval& interval, double unit) {
    if (!interval.is_known()) return "-";
    return fmt::format("[{:.3f} - {:.3f}]", interval.low / unit, interval.high / unit);
}

std::string bench_table(const BenchmarkRun& run) {
    const bool counted = run.uncounted.empty();
    BenchmarkTableCells cells{{"benchmark", "ms", "[95 %]", "cpu ms", "[95 %]"}};
    if (counted)
        for (const char* title : {"Mcycles", "[95 %]", "Minstr"}) cells.front().emplace_back(title);
    std::size_t rounds = 0;
    for (const BenchmarkResult& benchmark : run.benchmarks) {
        rounds = std::max(rounds, benchmark.rounds.size());
        cells.push_back(benchmark_cells(benchmark, counted));
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
           align_columns(cells);
}

std::string changes_table(const measure::BenchmarkChanges& changes) {
    BenchmarkTableCells cells{
        {"benchmark", "before", "after", "ratio", "[95 %]", "ms ratio", "[95 %]", ""}};
    for (const BenchmarkChange& change : changes.list)
        cells.push_back({escape(change.name), format_cost(change.medians[0], change.cost),
                         format_cost(change.medians[1], change.cost),
                         format_number(change.ratio.median), format_interval(change.ratio.ci95),
                         format_number(change.real_ratio.median),
                         format_interval(change.real_ratio.ci95), outcome_name(change.outcome())});
    return (changes.list.empty()
                ? "nothing is in both\n"
                : "compared by " + cost_kinds(changes) + "\n" + align_columns(cells, 7)) +
           format_count_changes(changes) + format_name_list("only before", changes.only_before) +
           format_name_list("only after", changes.only_after);
}

std::string describe_grown_work(const measure::BenchmarkChanges& changes) {
    std::string text;
    for (const BenchmarkChange& change : changes.list)
        for (const measure::WorkChange& count : change.counts)
            if (count.has_grown())
                text += fmt::format("{}{} {} {:.0f} instead of {:.0f}", text.empty() ? "" : ", ",
                                    change.name, count.name, count.after, count.before);
    return text;
}

std::string describe_slower(const measure::BenchmarkChanges& changes) {
    std::string text;
    for (const BenchmarkChange& change : changes.list)
        if (change.outcome() == BenchmarkChange::Outcome::slower)
            text += fmt::format("{}{} {:.3f} {}", text.empty() ? "" : ", ", change.name,
                                change.ratio.median, format_interval(change.ratio.ci95));
    return text;
}

} // namespace catoptric::cli
