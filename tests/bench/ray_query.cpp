// Compares the engine's walk of the BVH with the device's own ray query on the same rays. Both
// alternate in one process. Measures the processor time of all threads, because the ray query may
// run on a second driver.
//   catoptric_ray_query [ROUNDS]   at least 6 rounds; exit code 69 if no device has ray queries
#include "drivers/ray_query.hpp"
#include "benchmark/bench_subjects.hpp"
#include "drivers/witness_rays.hpp"
#include "import/load.hpp"
#include "measure/statistics.hpp"
#include "scene/built_in.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

using namespace catoptric;
using test::DeviceHit;
using test::DeviceRay;

constexpr int kRaysAcrossPicture = 512;         // rays per row and per column of the picture
constexpr std::size_t kSmallBatchRayCount = 64; // a small call, to measure the fixed cost of a call
constexpr std::size_t kMaxDifferingRays = 40;   // largest number of rays that may differ, at edges
constexpr int kNoDeviceExitCode = 69;

/// Returns one ray through each pixel of the scene's first camera, in blocks of 8x8 pixels.
std::vector<DeviceRay> make_camera_rays(const scene::Scene& scene,
                                        const render::SceneUnits& space) {
    const scene::Camera& camera = scene.cameras.front();
    const dvec3 forward = normalize(camera.target - camera.eye),
                right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const double half = std::tan(glm::radians(camera.vertical_fov_degrees) / 2);
    std::vector<DeviceRay> rays;
    for (int i = 0; i < kRaysAcrossPicture * kRaysAcrossPicture; ++i) {
        const int block = i / 64, x = block % (kRaysAcrossPicture / 8) * 8 + i % 8,
                  y = block / (kRaysAcrossPicture / 8) * 8 + i / 8 % 8;
        const dvec2 place = (dvec2(x, y) + .5) / (kRaysAcrossPicture / 2.0) - 1.0;
        rays.push_back(
            {.origin = vec3(space.to_scene_point(camera.eye)),
             .direction = vec3(normalize(forward + half * (place.x * right - place.y * up)))});
    }
    return rays;
}

std::size_t count_differing_hits(const std::vector<DeviceHit>& a, const std::vector<DeviceHit>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        count += a[i].is_hit() != b[i].is_hit() ||
                 !(std::abs(a[i].t - b[i].t) <= 1e-4f * std::max(1.0f, std::abs(a[i].t)));
    return count;
}

double processor_ms_of_round(const measure::BenchmarkResult& found, std::size_t round) {
    return round_costs(found, measure::CostKind::cpu_time)[round];
}

/// Prints the processor time of the ray query as a multiple of that of the engine's walk.
void compare_with_ray_query(const char* name, std::span<const bvh::Triangle> triangles,
                            const std::vector<DeviceRay>& rays, const test::DriverRayQuery& query,
                            int rounds) {
    test::DeviceRayTracer kernel(triangles);
    const std::size_t other = count_differing_hits(kernel.find_closest_hits(rays),
                                                   query.find_closest_hits(triangles, rays));
    check(other <= kMaxDifferingRays, Failure::internal, name, ": ", other, " of ", rays.size(),
          " rays meet something else, at most ", kMaxDifferingRays, " may");
    const std::vector<DeviceRay> few(rays.begin(), rays.begin() + kSmallBatchRayCount);
    const std::vector<benchmark::Subject> subjects{
        benchmark::make_subject("ours", [&] { kernel.find_closest_hits(rays); }),
        benchmark::make_subject("ours, few", [&] { kernel.find_closest_hits(few); }),
        benchmark::make_subject("query", [&] { query.find_closest_hits(triangles, rays); }),
        benchmark::make_subject("query, few", [&] { query.find_closest_hits(triangles, few); })};
    const session::UsageMeter meter(session::UsageMeter::Threads::process);
    const std::vector<measure::BenchmarkResult> found = benchmark::measure_rounds(
        subjects, meter, {.iterations = 3 * rounds, .rounds = rounds, .watcher = {}});
    std::vector<double> ours, theirs, ratios;
    for (std::size_t i = 0; i < found[0].rounds.size(); ++i) {
        ours.push_back(processor_ms_of_round(found[0], i) - processor_ms_of_round(found[1], i));
        theirs.push_back(processor_ms_of_round(found[2], i) - processor_ms_of_round(found[3], i));
        ratios.push_back(theirs.back() / ours.back());
    }
    const measure::SampleSummary ratio = measure::summarise(ratios);
    std::printf(
        "%-10s %zu rays: ours %.1f ms, ray query %.1f ms, which is %.2f times [%.2f - %.2f]; %zu rays differ\n",
        name, rays.size(), measure::summarise(ours).median, measure::summarise(theirs).median,
        ratio.median, ratio.p05, ratio.p95, other);
}

} // namespace

int main(int argc, char** argv) try {
    const int rounds = argc > 1 ? std::max(6, std::atoi(argv[1])) : 6;
    std::string reason;
    const auto device = test::RayQueryDevice::open(reason);
    if (!device) {
        std::fprintf(stderr, "catoptric_ray_query: %s\n", reason.c_str());
        return kNoDeviceExitCode;
    }
    const test::DriverRayQuery query(*device);
    const scene::Scene scene = scene::make_cornell();
    const render::SceneUnits space = render::make_scene_units(scene);
    const std::vector<bvh::Triangle> triangles = test::list_built_in_triangles();
    test::RandomNumbers numbers(7);
    std::printf("walk on %s, ray query on %s; %zu triangles\n",
                test::get_test_device().device.info().driver.c_str(), device->device_name().c_str(),
                triangles.size());
    compare_with_ray_query("camera", triangles, make_camera_rays(scene, space), query, rounds);
    compare_with_ray_query(
        "scattered", triangles,
        test::make_rays_in_bounds(triangles, std::size_t{kRaysAcrossPicture} * kRaysAcrossPicture,
                                  numbers),
        query, rounds);
    test::detail::devices = {}; // drivers can crash if called while the program is unloaded
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_ray_query: %s\n", error.what());
    return 1;
}
