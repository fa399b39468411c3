#include "measure/benchmark.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <limits>

namespace catoptric::measure {

namespace {

bool all_rounds_have(const BenchmarkResult& benchmark,
                     std::optional<double> BenchmarkRound::*count) {
    return std::ranges::all_of(benchmark.rounds, [count](const BenchmarkRound& round) {
        return (round.*count).has_value();
    });
}

CostKind choose_cost(const BenchmarkResult& before, const BenchmarkResult& after,
                     bool on_processors) {
    const auto both_have = [&](std::optional<double> BenchmarkRound::*count) {
        return all_rounds_have(before, count) && all_rounds_have(after, count);
    };
    if (!on_processors) return CostKind::real_time;
    if (both_have(&BenchmarkRound::cycles)) return CostKind::cycles;
    return both_have(&BenchmarkRound::instructions) ? CostKind::instructions : CostKind::cpu_time;
}

/// Compares the counts of work that both runs have. All rounds of a benchmark have the same counts.
void compare_work(const BenchmarkResult& before, const BenchmarkResult& after,
                  BenchmarkChange& change) {
    if (before.rounds.empty() || after.rounds.empty()) return;
    const std::map<std::string, double>& old_counts = before.rounds.back().counters;
    for (const auto& [name, count] : after.rounds.back().counters) {
        const auto old = old_counts.find(name);
        if (!name.starts_with(kWorkPrefix) || old == old_counts.end()) continue;
        ++change.compared_counts;
        if (old->second != count) change.counts.push_back({name, old->second, count});
    }
}

bool is_cpu_run(const BenchmarkRun& run) {
    return run.device.type.empty() || run.device.type == "cpu";
}

const BenchmarkResult* find_benchmark(const BenchmarkRun& run, const std::string& name) {
    const auto found = std::ranges::find(run.benchmarks, name, &BenchmarkResult::name);
    return found == run.benchmarks.end() ? nullptr : &*found;
}

BenchmarkChange find_change(const BenchmarkResult& before, const BenchmarkResult& after,
                            bool on_processors) {
    BenchmarkChange change;
    change.name = after.name;
    change.cost = choose_cost(before, after, on_processors);
    compare_work(before, after, change);
    const std::vector<double> old_costs = round_costs(before, change.cost);
    const std::vector<double> new_costs = round_costs(after, change.cost);
    change.medians = {percentile(old_costs, .5), percentile(new_costs, .5)};
    change.ratio = cost_ratio(new_costs, old_costs);
    change.real_ratio = cost_ratio(round_costs(after, CostKind::real_time),
                                   round_costs(before, CostKind::real_time));
    return change;
}

} // namespace

std::string cost_kind_name(CostKind cost) {
    switch (cost) {
    case CostKind::cycles: return "cycles";
    case CostKind::instructions: return "instructions";
    case CostKind::cpu_time: return "processor time";
    case CostKind::real_time: break;
    }
    return "time";
}

double cost_of(const BenchmarkRound& round, CostKind cost) {
    constexpr double kUnknownBenchmarkCost = std::numeric_limits<double>::quiet_NaN();
    switch (cost) {
    case CostKind::cycles: return round.cycles.value_or(kUnknownBenchmarkCost);
    case CostKind::instructions: return round.instructions.value_or(kUnknownBenchmarkCost);
    case CostKind::cpu_time: return round.cpu_ms;
    case CostKind::real_time: break;
    }
    return round.real_ms;
}

std::vector<double> round_costs(const BenchmarkResult& benchmark, CostKind cost) {
    std::vector<double> costs;
    for (const BenchmarkRound& round : benchmark.rounds) costs.push_back(cost_of(round, cost));
    return costs;
}

CostRatio cost_ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
    return {percentile(ratios, .5), median_ratio_interval(a, b)};
}

BenchmarkChange::Outcome BenchmarkChange::outcome() const {
    if (!ratio.ci95.is_known()) return Outcome::unknown;
    if (ratio.is_above_one()) return real_ratio.is_below_one() ? Outcome::mixed : Outcome::slower;
    if (ratio.is_below_one()) return real_ratio.is_above_one() ? Outcome::mixed : Outcome::faster;
    return Outcome::same;
}

std::string outcome_name(BenchmarkChange::Outcome outcome) {
    switch (outcome) {
    case BenchmarkChange::Outcome::slower: return "slower";
    case BenchmarkChange::Outcome::faster: return "faster";
    case BenchmarkChange::Outcome::mixed: return "mixed";
    case BenchmarkChange::Outcome::same: return "same";
    case BenchmarkChange::Outcome::unknown: break;
    }
    return "unknown";
}

BenchmarkChanges compare_runs(const BenchmarkRun& before, const BenchmarkRun& after) {
    const bool on_processors = is_cpu_run(before) && is_cpu_run(after);
    BenchmarkChanges changes;
    for (const BenchmarkResult& benchmark : after.benchmarks) {
        if (const BenchmarkResult* old = find_benchmark(before, benchmark.name))
            changes.list.push_back(find_change(*old, benchmark, on_processors));
        else
            changes.only_after.push_back(benchmark.name);
    }
    for (const BenchmarkResult& benchmark : before.benchmarks)
        if (!find_benchmark(after, benchmark.name)) changes.only_before.push_back(benchmark.name);
    return changes;
}

BenchmarkRun join_runs(BenchmarkRun first, const BenchmarkRun& more) {
    std::erase_if(first.benchmarks, [&](const BenchmarkResult& benchmark) {
        return !find_benchmark(more, benchmark.name);
    });
    for (BenchmarkResult& benchmark : first.benchmarks) {
        const std::vector<BenchmarkRound>& rounds = find_benchmark(more, benchmark.name)->rounds;
        benchmark.rounds.insert(benchmark.rounds.end(), rounds.begin(), rounds.end());
    }
    if (more.noisy) first.noisy = first.noisy.value_or(false) || *more.noisy;
    return first;
}

} // namespace catoptric::measure
