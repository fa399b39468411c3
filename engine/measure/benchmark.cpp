#include "measure/benchmark.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/statistics.hpp"

#include <algorithm>
#include <limits>

namespace catoptric::measure {

namespace {

bool has_count_in_all_rounds(const BenchmarkResult& benchmark,
                             std::optional<double> BenchmarkRound::*count) {
    return std::ranges::all_of(benchmark.rounds, [count](const BenchmarkRound& round) {
        return (round.*count).has_value();
    });
}

BenchmarkCostKind choose_benchmark_cost_kind(const BenchmarkResult& before,
                                             const BenchmarkResult& after, bool on_processors) {
    const auto both_have = [&](std::optional<double> BenchmarkRound::*count) {
        return has_count_in_all_rounds(before, count) && has_count_in_all_rounds(after, count);
    };
    if (!on_processors) return BenchmarkCostKind::real_time;
    if (both_have(&BenchmarkRound::cycles)) return BenchmarkCostKind::cycles;
    return both_have(&BenchmarkRound::instructions) ? BenchmarkCostKind::instructions
                                                    : BenchmarkCostKind::cpu_time;
}

/// Compares the counts of work that both runs have. All rounds of a benchmark have the same counts.
void compare_counted_work(const BenchmarkResult& before, const BenchmarkResult& after,
                          BenchmarkChange& change) {
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

const BenchmarkResult* find_benchmark(const BenchmarkRun& run, const std::string& name) {
    const auto found = std::ranges::find(run.benchmarks, name, &BenchmarkResult::name);
    return found == run.benchmarks.end() ? nullptr : &*found;
}

BenchmarkChange compute_benchmark_change(const BenchmarkResult& before,
                                         const BenchmarkResult& after, bool on_processors) {
    BenchmarkChange change;
    change.name = after.name;
    change.cost = choose_benchmark_cost_kind(before, after, on_processors);
    compare_counted_work(before, after, change);
    const std::vector<double> old_costs = list_benchmark_cost_per_round(before, change.cost);
    const std::vector<double> new_costs = list_benchmark_cost_per_round(after, change.cost);
    change.medians = {compute_percentile(old_costs, .5), compute_percentile(new_costs, .5)};
    change.ratio = compute_cost_ratio(new_costs, old_costs);
    change.real_ratio = compute_cost_ratio(
        list_benchmark_cost_per_round(after, BenchmarkCostKind::real_time),
        list_benchmark_cost_per_round(before, BenchmarkCostKind::real_time));
    return change;
}

} // namespace

std::string cost_kind_name(BenchmarkCostKind cost) {
    switch (cost) {
    case BenchmarkCostKind::cycles: return "cycles";
    case BenchmarkCostKind::instructions: return "instructions";
    case BenchmarkCostKind::cpu_time: return "processor time";
    case BenchmarkCostKind::real_time: break;
    }
    return "time";
}

double benchmark_cost_of_round(const BenchmarkRound& round, BenchmarkCostKind cost) {
    constexpr double kUnknownBenchmarkCost = std::numeric_limits<double>::quiet_NaN();
    switch (cost) {
    case BenchmarkCostKind::cycles: return round.cycles.value_or(kUnknownBenchmarkCost);
    case BenchmarkCostKind::instructions: return round.instructions.value_or(kUnknownBenchmarkCost);
    case BenchmarkCostKind::cpu_time: return round.cpu_ms;
    case BenchmarkCostKind::real_time: break;
    }
    return round.real_ms;
}

std::vector<double> list_benchmark_cost_per_round(const BenchmarkResult& benchmark,
                                                  BenchmarkCostKind cost) {
    std::vector<double> costs;
    for (const BenchmarkRound& round : benchmark.rounds)
        costs.push_back(benchmark_cost_of_round(round, cost));
    return costs;
}

BenchmarkCostRatio compute_cost_ratio(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) ratios.push_back(a[i] / b[i]);
    return {compute_percentile(ratios, .5), median_ratio_interval(a, b)};
}

BenchmarkChange::BenchmarkChangeOutcome BenchmarkChange::outcome() const {
    if (!ratio.ci95.is_known()) return BenchmarkChangeOutcome::unknown;
    if (ratio.is_interval_above_one())
        return real_ratio.is_interval_below_one() ? BenchmarkChangeOutcome::mixed
                                                  : BenchmarkChangeOutcome::slower;
    if (ratio.is_interval_below_one())
        return real_ratio.is_interval_above_one() ? BenchmarkChangeOutcome::mixed
                                                  : BenchmarkChangeOutcome::faster;
    return BenchmarkChangeOutcome::same;
}

std::string benchmark_outcome_name(BenchmarkChange::BenchmarkChangeOutcome outcome) {
    switch (outcome) {
    case BenchmarkChange::BenchmarkChangeOutcome::slower: return "slower";
    case BenchmarkChange::BenchmarkChangeOutcome::faster: return "faster";
    case BenchmarkChange::BenchmarkChangeOutcome::mixed: return "mixed";
    case BenchmarkChange::BenchmarkChangeOutcome::same: return "same";
    case BenchmarkChange::BenchmarkChangeOutcome::unknown: break;
    }
    return "unknown";
}

BenchmarkChanges compare_benchmark_runs(const BenchmarkRun& before, const BenchmarkRun& after) {
    const bool on_processors = is_cpu_device_run(before) && is_cpu_device_run(after);
    BenchmarkChanges changes;
    for (const BenchmarkResult& benchmark : after.benchmarks) {
        if (const BenchmarkResult* old = find_benchmark(before, benchmark.name))
            changes.list.push_back(compute_benchmark_change(*old, benchmark, on_processors));
        else
            changes.only_after.push_back(benchmark.name);
    }
    for (const BenchmarkResult& benchmark : before.benchmarks)
        if (!find_benchmark(after, benchmark.name)) changes.only_before.push_back(benchmark.name);
    return changes;
}

BenchmarkRun join_benchmark_runs(BenchmarkRun first, const BenchmarkRun& more) {
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
