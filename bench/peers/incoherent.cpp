// Comparison of incoherent rays, with random origins in a scene's bounds and random directions.
#include "cases.hpp"
#include "comparison.hpp"
#include "ray_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

namespace peers {

using namespace catoptric;
using measure::BenchmarkResult;

namespace {

constexpr std::size_t kRandomRayCount = 1 << 18;
// Largest difference of equal hits in t, scene units; relative if t > 1.
constexpr float kEqualHitTolerance = 1e-4F;

/// Returns a list of random rays in the triangles' bounds. Each call returns the same rays.
std::vector<Ray> make_random_rays_in_bounds(std::span<const bvh::Triangle> triangles) {
    Bounds<float> box;
    for (const bvh::Triangle& triangle : triangles)
        box.add(triangle.a), box.add(triangle.b), box.add(triangle.c);
    std::mt19937 words(7);
    const auto unit = [&] { return static_cast<float>(words() >> 8) * 0x1p-24F; };
    std::vector<Ray> rays(kRandomRayCount);
    for (auto& [origin, direction] : rays) {
        const vec3 part{unit(), unit(), unit()}, at = box.lo + part * (box.hi - box.lo);
        const float z = 2 * unit() - 1, angle = 6.2831853F * unit(), across = std::sqrt(1 - z * z);
        origin = {at.x, at.y, at.z};
        direction = {across * std::cos(angle), across * std::sin(angle), z};
    }
    return rays;
}

std::size_t count_hits(const std::vector<FirstRayHit>& met) {
    return met.size() - static_cast<std::size_t>(std::ranges::count(met, FirstRayHit::kNoTriangle,
                                                                    &FirstRayHit::triangle));
}

bool do_hits_differ_in_position(const FirstRayHit& a, const FirstRayHit& b) {
    if (a.triangle == FirstRayHit::kNoTriangle || b.triangle == FirstRayHit::kNoTriangle)
        return a.triangle != b.triangle;
    return !(std::abs(a.t - b.t) <= kEqualHitTolerance * std::max(1.0F, a.t));
}

/// Prints how Embree's hits differ from ours. Returns whether at most kMaxDifferingPixels rays have
/// hits at different positions.
bool print_and_check_ray_hit_differences(const std::string& name,
                                         const std::vector<FirstRayHit>& ours,
                                         const std::vector<FirstRayHit>& theirs) {
    std::size_t triangles = 0, places = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        triangles += theirs[i].triangle != ours[i].triangle;
        places += do_hits_differ_in_position(theirs[i], ours[i]);
    }
    std::printf("%-23s %zu rays, %zu hits; %zu another triangle, %zu another place\n", name.c_str(),
                theirs.size(), count_hits(theirs), triangles, places);
    return places <= kMaxDifferingPixels;
}

} // namespace

bool compare_random_rays_with_embree(const EmbreeComparisonBench& bench,
                                     const NamedSceneFactory& of) {
    const std::string name = std::string("rays/") + of.name;
    const std::vector<bvh::Triangle> triangles = make_bvh_triangles_of_scene(of.make());
    const std::vector<Ray> rays = make_random_rays_in_bounds(triangles);
    std::printf("\nrays in any direction, %s: %zu triangles\n", of.name, triangles.size());
    gpu::GpuDevice device{{}};
    gpu::PipelineStore pipelines(device);
    RayListBenchmark list(device, pipelines, triangles, rays);
    list.trace_all_rays();
    const std::vector<FirstRayHit> ours = list.read();
    std::printf("%-23s %zu rays, %zu hits\n", engine_benchmark_name(name).c_str(), ours.size(),
                count_hits(ours));
    bool same = std::ranges::count(ours, FirstRayHit::kUntraced, &FirstRayHit::triangle) == 0;
    EmbreeScene tree(bench.device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_HIGH);
    tree.add_geometry_and_release(make_triangle_geometry(bench.device, triangles));
    tree.build_tree();
    std::vector<app::BenchmarkSubject> subjects{app::make_benchmark_subject(
        engine_benchmark_name(name), [&] { list.trace_all_rays(); }, kWarmupFrameCount)};
    for (const int width : kEmbreePacketWidths) {
        const auto theirs = [&, width] {
            return find_closest_hits_of_rays(tree.embree_scene_handle(), rays, width,
                                             bench.threads);
        };
        same = print_and_check_ray_hit_differences(embree_benchmark_name(name, width), ours,
                                                   theirs()) &&
               same;
        subjects.push_back(app::make_benchmark_subject(embree_benchmark_name(name, width), theirs,
                                                       kWarmupFrameCount));
    }
    const std::vector<BenchmarkResult> found = app::measure_benchmarks_in_rounds(
        subjects, bench.meter,
        {.iterations = bench.rounds * kFramesPerRound, .rounds = bench.rounds, .watcher = {}});
    std::printf("\n");
    for (const BenchmarkResult& benchmark : found)
        print_benchmark(benchmark, "rays", kRandomRayCount / 1e6);
    print_cost_ratios_of_pair(found, name);
    return same;
}

} // namespace peers
