// Comparison of the first hits of ray lists: incoherent rays, with random origins in a scene's
// bounds and random directions, and coherent rays from the scene's camera.
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

/// Returns the camera's rays through the centres of all pixels. Each 64 rays cover 8x8 pixels, and
/// each 8 of them cover 4x2 pixels, as in technique `raytrace`.
std::vector<Ray> make_rays_of_camera(const WhittedTracerScene& view) {
    std::vector<Ray> rays;
    const auto pixels = static_cast<std::size_t>(view.width) *
                        static_cast<std::size_t>(view.height);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto tile = static_cast<int>(i / 64), block = static_cast<int>(i / 8 % 8),
                   lane = static_cast<int>(i % 8), tiles_across = view.width / 8;
        const int column = tile % tiles_across * 8 + block % 2 * 4 + lane % 4,
                  row = tile / tiles_across * 8 + block / 2 * 2 + lane / 4;
        const float x = (static_cast<float>(column) + .5F) / static_cast<float>(view.width) * 2 - 1,
                    y = (static_cast<float>(row) + .5F) / static_cast<float>(view.height) * 2 - 1;
        const auto along = [&](float PeerVector3::*axis) {
            return view.forward.*axis + view.right.*axis * x + view.down.*axis * y;
        };
        const vec3 direction = normalize(
            vec3(along(&PeerVector3::x), along(&PeerVector3::y), along(&PeerVector3::z)));
        rays.push_back({view.eye, {direction.x, direction.y, direction.z}});
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

/// Compares the first hits of a list of rays. Prints times and differences. Returns whether our
/// hits and Embree's agree.
bool compare_ray_list_with_embree(const EmbreeComparisonBench& bench, const std::string& name,
                                  const std::vector<bvh::Triangle>& triangles,
                                  const std::vector<Ray>& rays) {
    std::printf("\n%s: %zu triangles\n", name.c_str(), triangles.size());
    gpu::Device device{{}};
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
    std::vector<benchmark::Subject> subjects{benchmark::make_subject(
        engine_benchmark_name(name), [&] { list.trace_all_rays(); }, kWarmupFrameCount)};
    for (const int width : kEmbreePacketWidths) {
        const auto theirs = [&, width] {
            return find_closest_hits_of_rays(tree.embree_scene_handle(), rays, width,
                                             bench.threads);
        };
        same = print_and_check_ray_hit_differences(embree_benchmark_name(name, width), ours,
                                                   theirs()) &&
               same;
        subjects.push_back(
            benchmark::make_subject(embree_benchmark_name(name, width), theirs, kWarmupFrameCount));
    }
    const std::vector<BenchmarkResult> found = benchmark::measure_rounds(
        subjects, bench.meter,
        {.iterations = bench.rounds * kFramesPerRound, .rounds = bench.rounds, .watcher = {}});
    std::printf("\n");
    for (const BenchmarkResult& benchmark : found)
        print_benchmark(benchmark, "rays", static_cast<double>(rays.size()) / 1e6);
    print_cost_ratios_of_pair(found, name);
    return same;
}

} // namespace

bool compare_ray_lists_with_embree(const EmbreeComparisonBench& bench,
                                   const NamedSceneFactory& of) {
    const session::Request request = make_request_of_scene(of.make());
    const std::vector<bvh::Triangle> triangles = make_bvh_triangles_of_scene(request.scene);
    const EmbreeWhittedTracer tracer(bench.device, request, kMirrorBounces, false);
    const bool camera_rays_agree = compare_ray_list_with_embree(
        bench, std::string("camera-rays/") + of.name, triangles,
        make_rays_of_camera(tracer.whitted_tracer_scene()));
    return compare_ray_list_with_embree(bench, std::string("rays/") + of.name, triangles,
                                        make_random_rays_in_bounds(triangles)) &&
           camera_rays_agree;
}

} // namespace peers
