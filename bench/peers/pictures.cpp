#include "cases.hpp"
#include "comparison.hpp"

#include <cstdio>

namespace peers {

using namespace catoptric;
using measure::BenchmarkResult;

bool compare_whitted_pictures_with_embree(const EmbreeComparisonBench& bench,
                                          const NamedSceneFactory& of) {
    const session::Request request = make_request_of_scene(of.make());
    std::printf("\n%s: %zu triangles\n", of.name, scene::triangle_count(request.scene));
    const int frames = bench.rounds * kFramesPerRound;
    const EngineAndEmbreeBenchmarks shown = trace_pair_and_print_differences(
        bench.device, std::make_shared<session::Session>(bench.engine, request.scene), request,
        {of.name, "raytrace:depth=4"}, bench.threads, frames);
    const std::vector<BenchmarkResult> list = benchmark::measure_rounds(
        shown.subjects, bench.meter, {.iterations = frames, .rounds = bench.rounds, .watcher = {}});
    std::printf("\n");
    for (const BenchmarkResult& benchmark : list)
        print_benchmark(benchmark, "rays", shown.rays / 1e6);
    print_cost_ratios_of_pair(list, of.name);
    return shown.same;
}

} // namespace peers
