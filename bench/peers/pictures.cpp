#include "cases.hpp"
#include "comparison.hpp"

#include <cstdio>

namespace peers {

using namespace catoptric;
using measure::Benchmark;

bool compare_pictures(const Bench& bench, const NamedScene& of) {
    const app::Request request = request_of(of.make());
    std::printf("\n%s: %zu triangles\n", of.name, scene::triangle_count(request.scene));
    const int frames = bench.rounds * kFramesARound;
    const Shown shown = show(bench.device,
                             std::make_shared<app::Session>(bench.engine, request.scene), request,
                             {of.name, "raytrace:depth=4"}, bench.threads, frames);
    const std::vector<Benchmark> list = app::measure_in_rounds(
        shown.subjects, bench.meter, {.iterations = frames, .rounds = bench.rounds, .watcher = {}});
    std::printf("\n");
    for (const Benchmark& benchmark : list) print(benchmark, "rays", shown.rays / 1e6);
    print_ratios(list, of.name);
    return shown.same;
}

} // namespace peers
