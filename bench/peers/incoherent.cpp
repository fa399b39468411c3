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
using measure::Benchmark;

namespace {

constexpr std::size_t kRays = 1 << 18;
// Largest difference of equal hits in t, scene units; relative if t > 1.
constexpr float kSamePlace = 1e-4F;

/// Returns a list of random rays in the triangles' bounds. Each call returns the same rays.
std::vector<Ray> rays_in(std::span<const bvh::Triangle> triangles) {
    Bounds<float> box;
    for (const bvh::Triangle& triangle : triangles)
        box.add(triangle.a), box.add(triangle.b), box.add(triangle.c);
    std::mt19937 words(7);
    const auto unit = [&] { return static_cast<float>(words() >> 8) * 0x1p-24F; };
    std::vector<Ray> rays(kRays);
    for (auto& [origin, direction] : rays) {
        const vec3 part{unit(), unit(), unit()}, at = box.lo + part * (box.hi - box.lo);
        const float z = 2 * unit() - 1, angle = 6.2831853F * unit(), across = std::sqrt(1 - z * z);
        origin = {at.x, at.y, at.z};
        direction = {across * std::cos(angle), across * std::sin(angle), z};
    }
    return rays;
}

std::size_t hits_of(const std::vector<Met>& met) {
    return met.size() -
           static_cast<std::size_t>(std::ranges::count(met, Met::kNothing, &Met::triangle));
}

bool is_elsewhere(const Met& a, const Met& b) {
    if (a.triangle == Met::kNothing || b.triangle == Met::kNothing) return a.triangle != b.triangle;
    return !(std::abs(a.t - b.t) <= kSamePlace * std::max(1.0F, a.t));
}

/// Prints how Embree's hits differ from ours. Returns whether at most kMostOther rays have hits at
/// different positions.
bool meet_the_same(const std::string& name, const std::vector<Met>& ours,
                   const std::vector<Met>& theirs) {
    std::size_t triangles = 0, places = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        triangles += theirs[i].triangle != ours[i].triangle;
        places += is_elsewhere(theirs[i], ours[i]);
    }
    std::printf("%-23s %zu rays, %zu hits; %zu another triangle, %zu another place\n", name.c_str(),
                theirs.size(), hits_of(theirs), triangles, places);
    return places <= kMostOther;
}

} // namespace

bool compare_rays(const Bench& bench, const NamedScene& of) {
    const std::string name = std::string("rays/") + of.name;
    const std::vector<bvh::Triangle> triangles = triangles_of(of.make());
    const std::vector<Ray> rays = rays_in(triangles);
    std::printf("\nrays in any direction, %s: %zu triangles\n", of.name, triangles.size());
    gpu::Device device{{}};
    gpu::Pipelines pipelines(device);
    RayList list(device, pipelines, triangles, rays);
    list.trace();
    const std::vector<Met> ours = list.read();
    std::printf("%-23s %zu rays, %zu hits\n", our_name(name).c_str(), ours.size(), hits_of(ours));
    bool same = std::ranges::count(ours, Met::kUntraced, &Met::triangle) == 0;
    EmbreeScene tree(bench.device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_HIGH);
    tree.add_and_release(triangle_geometry(bench.device, triangles));
    tree.commit();
    std::vector<app::BenchmarkSubject> subjects{app::make_subject(
        our_name(name), [&] { list.trace(); }, kWarmup)};
    for (const int width : kWidths) {
        const auto theirs = [&, width] { return meet(tree.get(), rays, width, bench.threads); };
        same = meet_the_same(peer_name(name, width), ours, theirs()) && same;
        subjects.push_back(app::make_subject(peer_name(name, width), theirs, kWarmup));
    }
    const std::vector<Benchmark> found = app::measure_in_rounds(
        subjects, bench.meter,
        {.iterations = bench.rounds * kFramesARound, .rounds = bench.rounds, .watcher = {}});
    std::printf("\n");
    for (const Benchmark& benchmark : found) print(benchmark, "rays", kRays / 1e6);
    print_ratios(found, name);
    return same;
}

} // namespace peers
