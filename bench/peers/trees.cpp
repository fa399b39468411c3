#include "cases.hpp"
#include "comparison.hpp"
#include "embree_tree.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/load.hpp"

#include <cstdio>

namespace peers {

using namespace catoptric;
using measure::Benchmark;

namespace {

constexpr int kTorus = 1000; // segments of the torus, which has kTorus^2 triangles

void compare_builds(const Bench& bench, const std::vector<bvh::Triangle>& triangles) {
    RTCGeometry geometry = triangle_geometry(bench.device, triangles);
    const auto theirs = [&] {
        EmbreeScene tree(bench.device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_MEDIUM);
        tree.add(geometry);
        tree.commit();
    };
    const auto ours = [&](unsigned threads) {
        return [&triangles, threads] {
            bvh::build_bvh(triangles, {}, bvh::kMaxLeafTriangles, threads);
        };
    };
    const std::vector<Benchmark> list = app::measure_in_rounds(
        {app::make_subject("ours/build", ours(0)), app::make_subject("ours/build/1", ours(1)),
         app::make_subject("embree/build", theirs)},
        bench.meter, {.iterations = bench.rounds, .rounds = bench.rounds, .watcher = {}});
    rtcReleaseGeometry(geometry);
    std::printf("\n%zu triangles\n", triangles.size());
    for (const Benchmark& benchmark : list)
        print(benchmark, "triangles", static_cast<double>(triangles.size()) / 1e6);
    print_ratio(list[0], list[2]);
    print_ratio(list[1], list[2]);
}

/// Prints the ratios of a ray's expected cost in our tree to that in Embree's trees of two build
/// qualities.
void compare_costs(const EmbreeDevice& device, const std::string& name,
                   const std::vector<bvh::Triangle>& triangles) {
    const double ours = bvh::compute_sah_cost(bvh::build_bvh(triangles));
    std::printf("%-24s %8zu triangles, cost of the tree / Embree's: medium %.3f, high %.3f\n",
                name.c_str(), triangles.size(),
                ours / embree_cost(device, triangles, RTC_BUILD_QUALITY_MEDIUM),
                ours / embree_cost(device, triangles, RTC_BUILD_QUALITY_HIGH));
}

std::vector<bvh::Triangle> torus() {
    scene::Scene scene;
    scene.meshes.push_back(scene::torus("torus", 1, .4, kTorus));
    scene.materials.emplace_back();
    scene.objects.emplace_back();
    return triangles_of(scene);
}

} // namespace

void compare_trees(const Bench& bench) {
    const std::vector<bvh::Triangle> million = torus();
    compare_builds(bench, million);
    std::printf("\n");
    compare_costs(bench.device, "torus", million);
    for (const scene::BuiltInScene& scene : scene::list_built_in_scenes())
        compare_costs(bench.device, scene.name, triangles_of(scene.make()));
}

} // namespace peers
