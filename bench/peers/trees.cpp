#include "cases.hpp"
#include "comparison.hpp"
#include "embree_tree.hpp"
#include "import/load.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"

#include <cstdio>

namespace peers {

using namespace catoptric;
using measure::BenchmarkResult;

namespace {

constexpr int kTorusSegments = 1000; // segments of the torus, which has kTorusSegments^2 triangles

void compare_bvh_build_times_with_embree(const EmbreeComparisonBench& bench,
                                         const std::vector<bvh::Triangle>& triangles) {
    RTCGeometry geometry = make_triangle_geometry(bench.device, triangles);
    const auto theirs = [&] {
        EmbreeScene tree(bench.device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_MEDIUM);
        tree.add_geometry(geometry);
        tree.build_tree();
    };
    const auto ours = [&](unsigned threads) {
        return
            [&triangles, threads] { bvh::build(triangles, {}, bvh::kMaxLeafTriangles, threads); };
    };
    const std::vector<BenchmarkResult> list = benchmark::measure_rounds(
        {benchmark::make_subject("ours/build", ours(0)),
         benchmark::make_subject("ours/build/1", ours(1)),
         benchmark::make_subject("embree/build", theirs)},
        bench.meter, {.iterations = bench.rounds, .rounds = bench.rounds, .watcher = {}});
    rtcReleaseGeometry(geometry);
    std::printf("\n%zu triangles\n", triangles.size());
    for (const BenchmarkResult& benchmark : list)
        print_benchmark(benchmark, "triangles", static_cast<double>(triangles.size()) / 1e6);
    print_cost_ratio(list[0], list[2]);
    print_cost_ratio(list[1], list[2]);
}

/// Prints the ratios of a ray's expected cost in our tree to that in Embree's trees of two build
/// qualities.
void compare_bvh_sah_costs_with_embree(const EmbreeDevice& device, const std::string& name,
                                       const std::vector<bvh::Triangle>& triangles) {
    const double ours = bvh::sah_cost(bvh::build(triangles));
    std::printf("%-24s %8zu triangles, cost of the tree / Embree's: medium %.3f, high %.3f\n",
                name.c_str(), triangles.size(),
                ours / compute_embree_bvh_sah_cost(device, triangles, RTC_BUILD_QUALITY_MEDIUM),
                ours / compute_embree_bvh_sah_cost(device, triangles, RTC_BUILD_QUALITY_HIGH));
}

std::vector<bvh::Triangle> make_torus_triangle_list() {
    scene::Scene scene;
    scene.meshes.push_back(scene::torus("torus", 1, .4, kTorusSegments));
    scene.materials.emplace_back();
    scene.objects.emplace_back();
    return make_bvh_triangles_of_scene(scene);
}

} // namespace

void compare_bvhs_with_embree(const EmbreeComparisonBench& bench) {
    const std::vector<bvh::Triangle> million = make_torus_triangle_list();
    compare_bvh_build_times_with_embree(bench, million);
    std::printf("\n");
    compare_bvh_sah_costs_with_embree(bench.device, "torus", million);
    for (const scene::BuiltInScene& scene : scene::built_in_scenes())
        compare_bvh_sah_costs_with_embree(bench.device, scene.name,
                                          make_bvh_triangles_of_scene(scene.make()));
}

} // namespace peers
