#include "measure/benchmark.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <limits>

namespace catoptric::measure {

namespace {

bool has_cycles(const Benchmark& benchmark) {
    return std::ranges::all_of(
        benchmark.rounds, [](const BenchmarkRound& round) { return round.cycles.has_value(); });
}

bool is_on_processors(const BenchmarkRun& run) {
    return run.device.type.empty() || run.device.type == "cpu";
}

const Benchmark* find(const BenchmarkRun& run, const std::string& name) {
    const auto found = std::ranges::find(run.benchmarks, name, &Benchmark::name);
    return found == run.benchmarks.end() ? nullptr : &*found;
}

Change change_of(const Benchmark& before, const Benchmark& after, bool on_processors) {
    Change change;
    change.name = after.name;
    change.cost = !on_processors                            ? Cost::real_time
                  : has_cycles(before) && has_cycles(after) ? Cost::cycles
                                                            : Cost::cpu_time;
    const std::vector<double> old_costs = costs_of(before, change.cost);
    const std::vector<double> new_costs = costs_of(after, change.cost);
    change.medians = {percentile(old_costs, .5), percentile(new_costs, .5)};
    change.ratio = ratio_of(new_costs, old_costs);
    change.real_ratio = ratio_of(costs_of(after, Cost::real_time),
                                 costs_of(before, Cost::real_time));
    return change;
}

} // namespace

std::string name_of(Cost cost) {
    switch (cost) {
    case Cost::cycles: return "cycles";
    case Cost::cpu_time: return "processor time";
    case Cost::real_time: break;
    }
    return "time";
}

double cost_of(const BenchmarkRound& round, Cost cost) {
    switch (cost) {
    case Cost::cycles: return round.cycles.value_or(std::numeric_limits<double>::quiet_NaN());
    case Cost::cpu_time: return round.cpu_ms;
    case Cost::real_time: break;
    }
    return round.real_ms;
}

std::vector<double> costs_of(const Benchmark& benchmark, Cost cost) {
    std::vector<double> costs;
    for (const BenchmarkRound& round : benchmark.rounds) costs.push_back(cost_of(round, cost));
    return costs;
}

Ratio ratio_of(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
    return {percentile(ratios, .5), ratio_interval(a, b)};
}

Change::Outcome Change::outcome() const {
    if (!ratio.ci95.is_known()) return Outcome::unknown;
    if (ratio.is_above_one()) return real_ratio.is_below_one() ? Outcome::mixed : Outcome::slower;
    if (ratio.is_below_one()) return real_ratio.is_above_one() ? Outcome::mixed : Outcome::faster;
    return Outcome::same;
}

std::string name_of(Change::Outcome outcome) {
    switch (outcome) {
    case Change::Outcome::slower: return "slower";
    case Change::Outcome::faster: return "faster";
    case Change::Outcome::mixed: return "mixed";
    case Change::Outcome::same: return "same";
    case Change::Outcome::unknown: break;
    }
    return "unknown";
}

Changes compare(const BenchmarkRun& before, const BenchmarkRun& after) {
    const bool on_processors = is_on_processors(before) && is_on_processors(after);
    Changes changes;
    for (const Benchmark& benchmark : after.benchmarks) {
        if (const Benchmark* old = find(before, benchmark.name))
            changes.list.push_back(change_of(*old, benchmark, on_processors));
        else
            changes.only_after.push_back(benchmark.name);
    }
    for (const Benchmark& benchmark : before.benchmarks)
        if (!find(after, benchmark.name)) changes.only_before.push_back(benchmark.name);
    return changes;
}

BenchmarkRun joined(BenchmarkRun first, const BenchmarkRun& more) {
    std::erase_if(first.benchmarks,
                  [&](const Benchmark& benchmark) { return !find(more, benchmark.name); });
    for (Benchmark& benchmark : first.benchmarks) {
        const std::vector<BenchmarkRound>& rounds = find(more, benchmark.name)->rounds;
        benchmark.rounds.insert(benchmark.rounds.end(), rounds.begin(), rounds.end());
    }
    if (more.noisy) first.noisy = first.noisy.value_or(false) || *more.noisy;
    return first;
}

} // namespace catoptric::measure
