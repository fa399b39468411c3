#include "measure/benchmark.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <limits>

namespace catoptric::measure {

namespace {

bool has_counts(const Benchmark& benchmark, std::optional<double> BenchmarkRound::*count) {
    return std::ranges::all_of(benchmark.rounds, [count](const BenchmarkRound& round) {
        return (round.*count).has_value();
    });
}

CostKind choose_cost(const Benchmark& before, const Benchmark& after, bool on_processors) {
    const auto both_have = [&](std::optional<double> BenchmarkRound::*count) {
        return has_counts(before, count) && has_counts(after, count);
    };
    if (!on_processors) return CostKind::real_time;
    if (both_have(&BenchmarkRound::cycles)) return CostKind::cycles;
    return both_have(&BenchmarkRound::instructions) ? CostKind::instructions : CostKind::cpu_time;
}

/// Compares the counted work that both have. Every round of a benchmark has the same counts.
void compare_counts(const Benchmark& before, const Benchmark& after, BenchmarkChange& change) {
    if (before.rounds.empty() || after.rounds.empty()) return;
    const std::map<std::string, double>& old_counts = before.rounds.back().counters;
    for (const auto& [name, count] : after.rounds.back().counters) {
        const auto old = old_counts.find(name);
        if (!name.starts_with(kWorkCounterPrefix) || old == old_counts.end()) continue;
        ++change.compared_counts;
        if (old->second != count) change.counts.push_back({name, old->second, count});
    }
}

bool is_cpu_device_run(const BenchmarkRun& run) {
    return run.device.type.empty() || run.device.type == "cpu";
}

const Benchmark* find_benchmark(const BenchmarkRun& run, const std::string& name) {
    const auto found = std::ranges::find(run.benchmarks, name, &Benchmark::name);
    return found == run.benchmarks.end() ? nullptr : &*found;
}

BenchmarkChange compute_change(const Benchmark& before, const Benchmark& after,
                               bool on_processors) {
    BenchmarkChange change;
    change.name = after.name;
    change.cost = choose_cost(before, after, on_processors);
    compare_counts(before, after, change);
    const std::vector<double> old_costs = list_round_costs(before, change.cost);
    const std::vector<double> new_costs = list_round_costs(after, change.cost);
    change.medians = {compute_percentile(old_costs, .5), compute_percentile(new_costs, .5)};
    change.ratio = compute_cost_ratio(new_costs, old_costs);
    change.real_ratio = compute_cost_ratio(list_round_costs(after, CostKind::real_time),
                                           list_round_costs(before, CostKind::real_time));
    return change;
}

} // namespace

std::string name_of(CostKind cost) {
    switch (cost) {
    case CostKind::cycles: return "cycles";
    case CostKind::instructions: return "instructions";
    case CostKind::cpu_time: return "processor time";
    case CostKind::real_time: break;
    }
    return "time";
}

double round_cost(const BenchmarkRound& round, CostKind cost) {
    constexpr double kUnknownCost = std::numeric_limits<double>::quiet_NaN();
    switch (cost) {
    case CostKind::cycles: return round.cycles.value_or(kUnknownCost);
    case CostKind::instructions: return round.instructions.value_or(kUnknownCost);
    case CostKind::cpu_time: return round.cpu_ms;
    case CostKind::real_time: break;
    }
    return round.real_ms;
}

std::vector<double> list_round_costs(const Benchmark& benchmark, CostKind cost) {
    std::vector<double> costs;
    for (const BenchmarkRound& round : benchmark.rounds) costs.push_back(round_cost(round, cost));
    return costs;
}

CostRatio compute_cost_ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
    return {compute_percentile(ratios, .5), ratio_interval(a, b)};
}

BenchmarkChange::ChangeOutcome BenchmarkChange::outcome() const {
    if (!ratio.ci95.is_known()) return ChangeOutcome::unknown;
    if (ratio.is_above_one())
        return real_ratio.is_below_one() ? ChangeOutcome::mixed : ChangeOutcome::slower;
    if (ratio.is_below_one())
        return real_ratio.is_above_one() ? ChangeOutcome::mixed : ChangeOutcome::faster;
    return ChangeOutcome::same;
}

std::string name_of(BenchmarkChange::ChangeOutcome outcome) {
    switch (outcome) {
    case BenchmarkChange::ChangeOutcome::slower: return "slower";
    case BenchmarkChange::ChangeOutcome::faster: return "faster";
    case BenchmarkChange::ChangeOutcome::mixed: return "mixed";
    case BenchmarkChange::ChangeOutcome::same: return "same";
    case BenchmarkChange::ChangeOutcome::unknown: break;
    }
    return "unknown";
}

BenchmarkChanges compare_benchmark_runs(const BenchmarkRun& before, const BenchmarkRun& after) {
    const bool on_processors = is_cpu_device_run(before) && is_cpu_device_run(after);
    BenchmarkChanges changes;
    for (const Benchmark& benchmark : after.benchmarks) {
        if (const Benchmark* old = find_benchmark(before, benchmark.name))
            changes.list.push_back(compute_change(*old, benchmark, on_processors));
        else
            changes.only_after.push_back(benchmark.name);
    }
    for (const Benchmark& benchmark : before.benchmarks)
        if (!find_benchmark(after, benchmark.name)) changes.only_before.push_back(benchmark.name);
    return changes;
}

BenchmarkRun join_benchmark_runs(BenchmarkRun first, const BenchmarkRun& more) {
    std::erase_if(first.benchmarks, [&](const Benchmark& benchmark) {
        return !find_benchmark(more, benchmark.name);
    });
    for (Benchmark& benchmark : first.benchmarks) {
        const std::vector<BenchmarkRound>& rounds = find_benchmark(more, benchmark.name)->rounds;
        benchmark.rounds.insert(benchmark.rounds.end(), rounds.begin(), rounds.end());
    }
    if (more.noisy) first.noisy = first.noisy.value_or(false) || *more.noisy;
    return first;
}

} // namespace catoptric::measure
