// Measures the time of declaring, planning and dumping a render graph, per pass. The program is
// build/ci/catoptric_plan_bench.
#include "graph/dump.hpp"
#include "graph/plan.hpp"
#include "support/frames.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace catoptric;

constexpr graph::GraphLimits kTestGraphLimits{.max_layers = 1u << 20};

/// Adds the time per pass to the result, beside the time per graph.
void report_time_per_pass(benchmark::State& state, const graph::Graph& graph) {
    state.counters["a pass"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(graph.passes().size()),
        benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void measure_graph_declaration(benchmark::State& state) {
    const auto mirrors = static_cast<std::uint32_t>(state.range(0)) - 3;
    for (auto _ : state) benchmark::DoNotOptimize(test::make_reuse_graph(mirrors));
    report_time_per_pass(state, test::make_reuse_graph(mirrors));
}

void measure_graph_planning(benchmark::State& state) {
    const graph::Graph graph = test::make_reuse_graph(static_cast<std::uint32_t>(state.range(0)) -
                                                      3);
    const graph::MemorySizer sizer = graph::default_sizer();
    for (auto _ : state)
        benchmark::DoNotOptimize(graph::plan_graph(graph, kTestGraphLimits, sizer));
    report_time_per_pass(state, graph);
}

void measure_graph_dump(benchmark::State& state) {
    const graph::Graph graph = test::make_reuse_graph(static_cast<std::uint32_t>(state.range(0)) -
                                                      3);
    const graph::GraphPlan plan = graph::plan_graph(graph, kTestGraphLimits,
                                                    graph::default_sizer());
    for (auto _ : state) benchmark::DoNotOptimize(graph::plan_to_text(graph, plan));
    report_time_per_pass(state, graph);
}

// The arguments are the numbers of passes of a graph.
BENCHMARK(measure_graph_declaration)->Arg(34)->Arg(130)->Arg(302)->Arg(1003);
BENCHMARK(measure_graph_planning)->Arg(34)->Arg(130)->Arg(302)->Arg(1003);
BENCHMARK(measure_graph_dump)->Arg(34)->Arg(130)->Arg(302)->Arg(1003);

} // namespace

BENCHMARK_MAIN();
