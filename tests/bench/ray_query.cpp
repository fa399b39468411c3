// Compares the engine's walk of the BVH with the device's own ray query on the same rays. Both
// alternate in one process. Measures the processor time of all threads, because the ray query may
// run on a second driver.
//   catoptric_ray_query [ROUNDS]   at least 6 rounds; exit code 69 if no device has ray queries
#include "drivers/ray_query.hpp"
#include "benchmark/bench_subjects.hpp"
#include "drivers/witness_rays.hpp"
#include "measure/statistics.hpp"
#include "scene/built_in.hpp"
#include "scene/load.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;

constexpr int kAcross = 512;           // rays per row and per column of the picture
constexpr std::size_t kFewRays = 64;   // a small call, to measure the fixed cost of a call
constexpr std::size_t kMostOther = 40; // largest number of rays that may differ, at edges
constexpr int kNoDevice = 69;

/// Returns one ray through each pixel of the scene's first camera, in blocks of 8x8 pixels.
std::vector<DeviceRay> camera_rays(const scene::Scene& scene, const render::SceneUnits& space) {
    const scene::Camera& camera = scene.cameras.front();
    const dvec3 forward = normalize(camera.target - camera.eye),
                right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const double half = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    std::vector<DeviceRay> rays;
    for (int i = 0; i < kAcross * kAcross; ++i) {
        const int block = i / 64, x = block % (kAcross / 8) * 8 + i % 8,
                  y = block / (kAcross / 8) * 8 + i / 8 % 8;
        const dvec2 place = (dvec2(x, y) + .5) / (kAcross / 2.0) - 1.0;
        rays.push_back(
            {.origin = vec3(space.to_scene_point(camera.eye)),
             .direction = vec3(normalize(forward + half * (place.x * right - place.y * up)))});
    }
    return rays;
}

std::size_t differing(const std::vector<DeviceHit>& a, const std::vector<DeviceHit>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += a[i].is_hit() != b[i].is_hit() ||
                 !(std::abs(a[i].t - b[i].t) <= 1e-4f * std::max(1.0f, std::abs(a[i].t)));
    return count;
}

double processor_ms(const measure::Benchmark& found, std::size_t round) {
    return list_round_costs(found, measure::CostKind::cpu_time)[round];
}

/// Prints the processor time of the ray query as a multiple of that of the engine's walk.
void compare(const char* name, std::span<const bvh::Triangle> triangles,
             const std::vector<DeviceRay>& rays, const test::RayQuery& query, int rounds) {
    test::DeviceRayTracer kernel(triangles);
    const std::size_t other = differing(kernel.find_closest_hits(rays),
                                        query.closest(triangles, rays));
    check(other <= kMostOther, Failure::internal, name, ": ", other, " of ", rays.size(),
          " rays meet something else, at most ", kMostOther, " may");
    const std::vector<DeviceRay> few(rays.begin(), rays.begin() + kFewRays);
    const std::vector<app::BenchmarkSubject> subjects{
        app::make_subject("ours", [&] { kernel.find_closest_hits(rays); }),
        app::make_subject("ours, few", [&] { kernel.find_closest_hits(few); }),
        app::make_subject("query", [&] { query.closest(triangles, rays); }),
        app::make_subject("query, few", [&] { query.closest(triangles, few); })};
    const app::UsageMeter meter(app::UsageMeter::CountedThreads::process);
    const std::vector<measure::Benchmark> found = app::measure_in_rounds(
        subjects, meter, {.iterations = 3 * rounds, .rounds = rounds, .watcher = {}});
    std::vector<double> ours, theirs, ratios;
    for (std::size_t i = 0; i < found[0].rounds.size(); ++i) {
        ours.push_back(processor_ms(found[0], i) - processor_ms(found[1], i));
        theirs.push_back(processor_ms(found[2], i) - processor_ms(found[3], i));
        ratios.push_back(theirs.back() / ours.back());
    }
    const measure::SampleSummary ratio = measure::summarise_samples(ratios);
    std::printf(
        "%-10s %zu rays: ours %.1f ms, ray query %.1f ms, which is %.2f times [%.2f - %.2f]; %zu rays differ\n",
        name, rays.size(), measure::summarise_samples(ours).median,
        measure::summarise_samples(theirs).median, ratio.median, ratio.p05, ratio.p95, other);
}

} // namespace

int main(int argc, char** argv) try {
    const int rounds = argc > 1 ? std::max(6, std::atoi(argv[1])) : 6;
    std::string reason;
    const auto device = test::RayQueryDevice::open(reason);
    if (!device) {
        std::fprintf(stderr, "catoptric_ray_query: %s\n", reason.c_str());
        return kNoDevice;
    }
    const test::RayQuery query(*device);
    const scene::Scene scene = scene::make_cornell_mirrors();
    const render::SceneUnits space = render::make_scene_units(scene);
    const std::vector<bvh::Triangle> triangles = test::built_in_scene();
    test::RandomNumbers numbers(7);
    std::printf("walk on %s, ray query on %s; %zu triangles\n",
                test::test_device().device.info().driver.c_str(), device->name().c_str(),
                triangles.size());
    compare("camera", triangles, camera_rays(scene, space), query, rounds);
    compare("scattered", triangles,
            test::rays_anywhere(triangles, std::size_t{kAcross} * kAcross, numbers), query, rounds);
    test::detail::devices = {}; // drivers can crash if called while the program is unloaded
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_ray_query: %s\n", error.what());
    return 1;
}
