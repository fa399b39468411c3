// Ours beside Embree 3 and beside plain prototypes: the Whitted picture of the built-in scene,
// frames with captures and the building of trees, in turn in one process.
//   catoptric_peers [ROUNDS]      at least 6; exit code 1 where the pictures differ
#include "app/bench_subjects.hpp"
#include "embree_tree.hpp"
#include "measure/statistics.hpp"
#include "peer_scene.hpp"
#include "prototypes.hpp"
#include "scene/load.hpp"
#include "scene/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

namespace {

using namespace catoptric;
using measure::Benchmark;
using measure::Cost;
using peers::PeerScene;

constexpr int kDepth = 4;
constexpr float kSame = 1e-3F;         // of a channel, linear
constexpr std::size_t kMostOther = 10; // pixels
constexpr int kFramesARound = 4, kWarmup = 8;
constexpr int kTorus = 1000; // around; its square is the count of triangles

/// A picture of ours and Embree's of the same scene.
struct Pair {
    const char* name;
    const char* technique;
    bool exact;
};
constexpr Pair kPairs[] = {{"mesh", "raytrace:depth=4", false},
                           {"exact", "raytrace:depth=4,sphere=exact", true}};
constexpr int kWidths[] = {1, 8, 16};
/// Rows of ours beside which Embree's single rays are only a unit of time, and their faces.
constexpr std::pair<const char*, int> kOthers[] = {
    {"parallax:face=64", 64}, {"parallax", 256}, {"parallax:face=512", 512}};
constexpr int kSettles = 14; // frames

std::size_t other_pixels(const measure::Picture& ours, const std::vector<peers::Vector>& theirs) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < theirs.size(); ++i) {
        const auto& [x, y, z] = theirs[i];
        const vec3 apart = abs(ours.pixels[i] - vec3(x, y, z));
        count += !(std::max({apart.x, apart.y, apart.z}) <= kSame); // also what is no number
    }
    return count;
}

std::string peer_name(const Pair& pair, int width) {
    return std::string("embree/") + pair.name + "/" + std::to_string(width);
}
std::string our_name(const Pair& pair) { return std::string("ours/") + pair.name; }

/// Prints what both traced; whether it is the same picture.
bool check_pictures(app::Session& session, app::Request request, const Pair& pair,
                    const PeerScene& peer, int threads) {
    request.techniques = {pair.technique};
    const app::Part ours = session.frame(request).read();
    const app::RayCounts rays = ours.rays.value();
    std::printf("%-16s %llu rays\n", our_name(pair).c_str(),
                static_cast<unsigned long long>(rays.primary + rays.mirror + rays.shadow));
    bool same = true;
    for (const int width : kWidths) {
        const peers::Traced theirs = peer.trace(width, threads);
        const std::size_t other = other_pixels(ours.hdr, theirs.pixels);
        std::printf(
            "%-16s %llu rays, %zu pixels differ by more than %g\n", peer_name(pair, width).c_str(),
            static_cast<unsigned long long>(theirs.rays.all()), other, static_cast<double>(kSame));
        same = same && other <= kMostOther;
    }
    return same;
}

/// Prints how far the prototypes' pictures are from ours; whether those that trace show the same.
bool check_prototypes(app::Session& session, app::Request request, peers::Prototypes& prototypes) {
    for (app::Subject& subject : prototypes.subjects(0))
        for (int i = 0; i < kSettles; ++i) subject.work();
    request.techniques = {kPairs[0].technique};
    const measure::Picture traced = session.frame(request).read().hdr;
    bool same = true;
    for (const std::string& name : peers::Prototypes::tracers()) {
        const std::size_t other = other_pixels(traced, prototypes.read(name));
        std::printf("%-16s %zu pixels differ by more than %g\n", name.c_str(), other,
                    static_cast<double>(kSame));
        same = same && other <= kMostOther;
    }
    request.frames = kSettles;
    for (const auto& [technique, face] : kOthers) {
        request.techniques = {technique};
        const measure::Picture ours = app::run(session, request).parts.front().hdr;
        const std::vector<peers::Vector> theirs = prototypes.read(peers::Prototypes::name_of(face));
        double squares = 0;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
            const vec3 apart = ours.pixels[i] - vec3(theirs[i].x, theirs[i].y, theirs[i].z);
            squares += dot(dvec3(apart), dvec3(apart)) / 3;
        }
        std::printf("%-16s rmse %.4f from %s, %zu pixels differ by more than %g\n",
                    peers::Prototypes::name_of(face).c_str(),
                    std::sqrt(squares / static_cast<double>(theirs.size())), technique,
                    other_pixels(ours, theirs), static_cast<double>(kSame));
    }
    return same;
}

/// `millions`: of what an iteration does; 0: not said.
void print(const Benchmark& benchmark, const char* what, double millions) {
    const double ms = measure::percentile(costs_of(benchmark, Cost::real_time), .5);
    std::printf("%-18s %9.2f ms %9.2f ms of processors", benchmark.name.c_str(), ms,
                measure::percentile(costs_of(benchmark, Cost::cpu_time), .5));
    if (benchmark.rounds.front().cycles)
        std::printf(" %9.1f Mcycles",
                    measure::percentile(costs_of(benchmark, Cost::cycles), .5) / 1e6);
    if (millions > 0) std::printf(" %8.2f M%s/s", 1e3 * millions / ms, what);
    std::printf("\n");
}

const Benchmark& named(const std::vector<Benchmark>& list, const std::string& name) {
    return *std::ranges::find(list, name, &Benchmark::name);
}

void print_ratio(const Benchmark& a, const Benchmark& b) {
    const Cost cost = a.rounds.front().cycles ? Cost::cycles : Cost::cpu_time;
    const measure::Ratio ratio = measure::ratio_of(costs_of(a, cost), costs_of(b, cost));
    const measure::Ratio real = measure::ratio_of(costs_of(a, Cost::real_time),
                                                  costs_of(b, Cost::real_time));
    std::printf("%-17s / %-15s %6.3f [%.3f - %.3f] of %s, %6.3f [%.3f - %.3f] on the clock\n",
                a.name.c_str(), b.name.c_str(), ratio.median, ratio.ci95.low, ratio.ci95.high,
                measure::name_of(cost).c_str(), real.median, real.ci95.low, real.ci95.high);
}

/// Frames of both; whether their pictures are the same.
bool compare_frames(const app::UsageMeter& meter, const peers::EmbreeDevice& device, int rounds) {
    app::Engine engine({});
    const int threads = std::max(1, engine.device().threads);
    std::printf("%s, %s; Embree %s, packets of 16 %s; %d threads each\n",
                engine.device().name.c_str(), engine.device().driver.c_str(), RTC_VERSION_STRING,
                rtcGetDeviceProperty(device.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)
                    ? "native"
                    : "emulated",
                threads);
    app::Request request;
    request.scene = scene::cornell_mirrors();
    request.camera = request.scene.cameras.front();
    request.warmup = kWarmup;
    const auto session = std::make_shared<app::Session>(engine, request.scene);
    const int iterations = rounds * kFramesARound;
    std::vector<app::Subject> subjects;
    bool same = true;
    double rays = 0;
    for (const Pair& pair : kPairs) {
        const auto peer = std::make_shared<PeerScene>(device, request, kDepth, pair.exact);
        same = check_pictures(*session, request, pair, *peer, threads) && same;
        rays = static_cast<double>(peer->trace(1, threads).rays.all());
        request.techniques = {pair.technique};
        subjects.push_back(app::frame_subject(session, request, iterations));
        subjects.back().name = our_name(pair), subjects.back().caller.clear();
        for (const int width : kWidths)
            subjects.push_back(app::subject_of(
                peer_name(pair, width), [peer, width, threads] { peer->trace(width, threads); },
                kWarmup));
    }
    const PeerScene mesh(device, request, kDepth, false);
    peers::Prototypes prototypes(request, mesh);
    same = check_prototypes(*session, request, prototypes) && same;
    std::ranges::move(prototypes.subjects(kWarmup), std::back_inserter(subjects));
    for (const auto& [technique, face] : kOthers) {
        request.techniques = {technique};
        subjects.push_back(app::frame_subject(session, request, iterations));
        subjects.back().name = technique, subjects.back().caller.clear();
    }
    const std::vector<Benchmark> list = app::measure_rounds(
        subjects, meter, {.iterations = iterations, .rounds = rounds, .watcher = {}});
    std::printf("\n");
    for (const Benchmark& benchmark : list)
        print(benchmark, "rays", benchmark.name.starts_with("parallax") ? 0 : rays / 1e6);
    std::printf("\n");
    for (const Pair& pair : kPairs)
        for (const int width : kWidths)
            print_ratio(named(list, our_name(pair)), named(list, peer_name(pair, width)));
    print_ratio(named(list, "ours/exact"), named(list, "ours/mesh"));
    for (const auto& [technique, face] : kOthers)
        print_ratio(named(list, technique), named(list, peer_name(kPairs[0], 1)));
    for (const std::string& prototype : peers::Prototypes::tracers())
        print_ratio(named(list, our_name(kPairs[0])), named(list, prototype));
    for (const auto& [technique, face] : kOthers)
        print_ratio(named(list, technique), named(list, peers::Prototypes::name_of(face)));
    return same;
}

void compare_builds(const app::UsageMeter& meter, const peers::EmbreeDevice& device, int rounds,
                    const std::vector<bvh::Triangle>& triangles) {
    RTCGeometry geometry = peers::triangle_geometry(device, triangles);
    const auto theirs = [&] {
        peers::EmbreeScene tree(device, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_MEDIUM);
        tree.add(geometry);
        tree.commit();
    };
    const auto ours = [&](unsigned threads) {
        return [&triangles, threads] { bvh::build(triangles, {}, bvh::kMaxLeaf, threads); };
    };
    const std::vector<Benchmark> list = app::measure_rounds(
        {app::subject_of("ours/build", ours(0)), app::subject_of("ours/build/1", ours(1)),
         app::subject_of("embree/build", theirs)},
        meter, {.iterations = rounds, .rounds = rounds, .watcher = {}});
    rtcReleaseGeometry(geometry);
    std::printf("\n%zu triangles\n", triangles.size());
    for (const Benchmark& benchmark : list)
        print(benchmark, "triangles", static_cast<double>(triangles.size()) / 1e6);
    print_ratio(list[0], list[2]);
    print_ratio(list[1], list[2]);
}

/// What a ray's walk is expected to cost in our tree, beside Embree's of two qualities.
void compare_trees(const peers::EmbreeDevice& device, const std::string& name,
                   const std::vector<bvh::Triangle>& triangles) {
    const double ours = bvh::cost(bvh::build(triangles));
    std::printf("%-24s %8zu triangles, cost of the tree / Embree's: medium %.3f, high %.3f\n",
                name.c_str(), triangles.size(),
                ours / peers::embree_cost(device, triangles, RTC_BUILD_QUALITY_MEDIUM),
                ours / peers::embree_cost(device, triangles, RTC_BUILD_QUALITY_HIGH));
}

std::vector<bvh::Triangle> torus() {
    scene::Scene scene;
    scene.meshes.push_back(scene::torus("torus", 1, .4, kTorus));
    scene.materials.emplace_back();
    scene.objects.emplace_back();
    return peers::triangles_of(scene);
}

} // namespace

int main(int argc, char** argv) try {
    const app::UsageMeter meter(app::UsageMeter::Of::process); // before any other thread is there
    const int rounds = std::max(static_cast<int>(measure::kFewest),
                                argc > 1 ? std::atoi(argv[1]) : 0);
    if (!meter.uncounted().empty())
        std::printf("cycles are not counted: %s\n", meter.uncounted().c_str());
    const peers::EmbreeDevice device;
    const bool same = compare_frames(meter, device, rounds);
    compare_builds(meter, device, rounds, torus());
    std::printf("\n");
    compare_trees(device, "torus", torus());
    for (const scene::BuiltIn& scene : scene::built_in_scenes())
        compare_trees(device, scene.name, peers::triangles_of(scene.make()));
    return same ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_peers: %s\n", error.what());
    return 1;
}
