// Comparisons in the built-in scene: our traced pictures with Embree's and with prototypes, and our
// captures with prototypes. For captures, the time of one Embree frame is only a unit.
#include "scene/built_in.hpp"
#include "cases.hpp"
#include "comparison.hpp"
#include "import/load.hpp"
#include "prototypes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace peers {

using namespace catoptric;
using measure::BenchmarkResult;

namespace {

const EnginePeerPicturePair kTracedPicturePairs[] = {
    {"mesh", "raytrace:depth=4", false}, {"exact", "raytrace:depth=4,sphere=exact", true}};
/// Our row whose first hits the rasteriser finds. Its shadows come from a shadow map where the map
/// is certain, so its picture differs from Embree's in some pixels.
constexpr const char* kRasterisedFirstHitRow = "raytrace:depth=4,first=raster";
/// Our rows with captures, and the edges of their faces. Embree's single rays are only a unit of
/// time for these rows.
constexpr std::pair<const char*, int> kCaptureRowsAndFaceEdges[] = {
    {"parallax:face=64", 64}, {"parallax", 256}, {"parallax:face=512", 512}};
constexpr int kSettlingFrames = 14; // frames until mirrors seen in mirrors no longer change

/// Prints how much the prototypes' pictures differ from ours. Returns whether the pictures of the
/// prototypes that trace rays equal ours.
bool compare_prototype_and_engine_pictures(session::Session& session, session::Request request,
                                           PrototypeFrameRenderer& prototypes) {
    for (benchmark::Subject& subject : prototypes.subjects(0))
        for (int i = 0; i < kSettlingFrames; ++i) subject.work();
    request.techniques = {kTracedPicturePairs[0].technique};
    const measure::Picture traced = session.frame(request).read().hdr;
    bool same = true;
    for (const std::string& name : PrototypeFrameRenderer::tracers()) {
        const std::size_t other = count_differing_pixels(traced, prototypes.read(name));
        std::printf("%-23s %zu pixels differ by more than %g\n", name.c_str(), other,
                    static_cast<double>(kMaxEqualPixelDifference));
        same = same && other <= kMaxDifferingPixels;
    }
    request.frames = kSettlingFrames;
    for (const auto& [technique, face] : kCaptureRowsAndFaceEdges) {
        request.techniques = {technique};
        const measure::Picture ours = session::run(session, request).parts.front().hdr;
        const std::vector<PeerVector3> theirs = prototypes.read(
            PrototypeFrameRenderer::prototype_benchmark_name(face));
        double squares = 0;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
            const vec3 apart = ours.pixels[i] - vec3(theirs[i].x, theirs[i].y, theirs[i].z);
            squares += dot(dvec3(apart), dvec3(apart)) / 3;
        }
        std::printf("%-23s rmse %.4f from %s, %zu pixels differ by more than %g\n",
                    PrototypeFrameRenderer::prototype_benchmark_name(face).c_str(),
                    std::sqrt(squares / static_cast<double>(theirs.size())), technique,
                    count_differing_pixels(ours, theirs),
                    static_cast<double>(kMaxEqualPixelDifference));
    }
    return same;
}

} // namespace

bool compare_built_in_scene_pictures(const EmbreeComparisonBench& bench) {
    session::Request request = make_request_of_scene(scene::make_cornell());
    const auto session = std::make_shared<session::Session>(bench.engine, request.scene);
    const int frames = bench.rounds * kFramesPerRound;
    std::vector<benchmark::Subject> subjects;
    bool same = true;
    double rays = 0;
    for (const EnginePeerPicturePair& pair : kTracedPicturePairs) {
        EngineAndEmbreeBenchmarks shown = trace_pair_and_print_differences(
            bench.device, session, request, pair, bench.threads, frames);
        std::ranges::move(shown.subjects, std::back_inserter(subjects));
        rays = shown.rays;
        same = same && shown.same;
    }
    request.techniques = {kRasterisedFirstHitRow};
    const EmbreeWhittedTracer mesh(bench.device, request, kMirrorBounces, false);
    std::printf("%-23s %zu pixels differ by more than %g\n", kRasterisedFirstHitRow,
                count_differing_pixels(session->frame(request).read().hdr,
                                       mesh.trace_picture(1, bench.threads).pixels),
                static_cast<double>(kMaxEqualPixelDifference));
    PrototypeFrameRenderer prototypes(request, mesh);
    same = compare_prototype_and_engine_pictures(*session, request, prototypes) && same;
    std::ranges::move(prototypes.subjects(kWarmupFrameCount), std::back_inserter(subjects));
    std::vector<const char*> other_rows{kRasterisedFirstHitRow};
    for (const auto& [technique, face] : kCaptureRowsAndFaceEdges) other_rows.push_back(technique);
    for (const char* technique : other_rows) {
        request.techniques = {technique};
        subjects.push_back(benchmark::make_frame_subject(session, request, frames));
        subjects.back().name = technique, subjects.back().caller.clear();
    }
    const std::vector<BenchmarkResult> list = benchmark::measure_rounds(
        subjects, bench.meter, {.iterations = frames, .rounds = bench.rounds, .watcher = {}});
    std::printf("\n");
    for (const BenchmarkResult& benchmark : list) {
        const bool is_other_row = std::ranges::count(other_rows, benchmark.name) > 0;
        print_benchmark(benchmark, "rays", is_other_row ? 0 : rays / 1e6);
    }
    std::printf("\n");
    for (const EnginePeerPicturePair& pair : kTracedPicturePairs)
        print_cost_ratios_of_pair(list, pair.name);
    print_cost_ratio(find_benchmark_by_name(list, "ours/exact"),
                     find_benchmark_by_name(list, "ours/mesh"));
    for (const char* technique : other_rows)
        print_cost_ratio(find_benchmark_by_name(list, technique),
                         find_benchmark_by_name(list, embree_benchmark_name("mesh", 1)));
    print_cost_ratio(find_benchmark_by_name(list, kRasterisedFirstHitRow),
                     find_benchmark_by_name(list, embree_benchmark_name("exact", 1)));
    for (const std::string& prototype : PrototypeFrameRenderer::tracers())
        print_cost_ratio(find_benchmark_by_name(list, "ours/mesh"),
                         find_benchmark_by_name(list, prototype));
    for (const auto& [technique, face] : kCaptureRowsAndFaceEdges)
        print_cost_ratio(
            find_benchmark_by_name(list, technique),
            find_benchmark_by_name(list, PrototypeFrameRenderer::prototype_benchmark_name(face)));
    return same;
}

} // namespace peers
