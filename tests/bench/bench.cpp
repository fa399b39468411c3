// Measures the ratios of times that the documentation quotes. Each ratio compares two runs that
// alternate in one process, because times drift and only ratios within one run are reliable. Prints
// medians with their spread and judges nothing.
//   catoptric_bench [ROUNDS]        compares ways to organise shaders and passes
//   catoptric_bench rules [ROUNDS]  measures the cost of each rule of docs/robustness.md
//   catoptric_bench repeats TIMES ROW ROW...   counts how often a comparison calls rows different
#include "benchmark/bench_subjects.hpp"
#include "import/load.hpp"
#include "measure/statistics.hpp"
#include "render/nearest.hpp"
#include "repeats.hpp"
#include "scene/built_in.hpp"
#include "scene/repair.hpp"
#include "session/access.hpp"
#include "support/wanted_device.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

using namespace catoptric;

/// One side of a compared pair: an engine and a technique.
struct ComparedConfiguration {
    const char* name;
    session::Engine& engine;
    std::string technique;
};

benchmark::Subject make_frame_subject_of_side(const ComparedConfiguration& side,
                                              session::Request request, int rounds) {
    request.techniques = {side.technique};
    const auto session = std::make_shared<session::Session>(side.engine, request.scene);
    benchmark::Subject subject = benchmark::make_frame_subject(session, request,
                                                               rounds * request.frames);
    subject.name = side.name; // two engines may draw the same technique
    subject.caller.clear();
    return subject;
}

std::vector<double> list_gpu_ms_of_rounds(const measure::BenchmarkResult& benchmark) {
    std::vector<double> samples;
    for (const measure::BenchmarkRound& round : benchmark.rounds)
        samples.push_back(round.counters.at("gpu_ms"));
    return samples;
}

/// GPU milliseconds of each side, and the ratio a / b of each pair of frames.
struct PairedFrameTimes {
    measure::SampleSummary a, b, ratio;
};

PairedFrameTimes measure_paired_frames(const ComparedConfiguration& a,
                                       const ComparedConfiguration& b, const session::Request& base,
                                       int rounds) {
    const session::UsageMeter meter(session::UsageMeter::Threads::process);
    const std::vector<measure::BenchmarkResult> found = benchmark::measure_rounds(
        {make_frame_subject_of_side(a, base, rounds), make_frame_subject_of_side(b, base, rounds)},
        meter, {.iterations = rounds * base.frames, .rounds = rounds, .watcher = {}});
    const std::vector<double> a_ms = list_gpu_ms_of_rounds(found[0]),
                              b_ms = list_gpu_ms_of_rounds(found[1]);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a_ms.size(); ++i) ratios.push_back(a_ms[i] / b_ms[i]);
    return {measure::summarise(a_ms), measure::summarise(b_ms), measure::summarise(ratios)};
}

void compare_two_configurations(const char* title, const ComparedConfiguration& a,
                                const ComparedConfiguration& b, const session::Request& base,
                                int rounds) {
    const PairedFrameTimes pairs = measure_paired_frames(a, b, base, rounds);
    std::printf("%s\n  %-28s %8.2f ms\n  %-28s %8.2f ms\n  ratio %.3f [%.3f, %.3f] over %d pairs\n",
                title, a.name, pairs.a.median, b.name, pairs.b.median, pairs.ratio.median,
                pairs.ratio.p05, pairs.ratio.p95, rounds);
}

void compare_tree_shapes(const session::Request& base, int rounds) {
    const std::string device = test::read_wanted_device_name();
    session::Engine plain({.device = device}),
        naive_engine(session::Access::make_engine(
            {.device = device}, {.shader_variants = {{"raytrace.comp", "raytrace.comp#naive"}}})),
        faces_engine(session::Access::make_engine({.device = device}, {.layered = false}));
    ComparedConfiguration fast{"default", plain, "raytrace:depth=4"},
        naive{"naive", naive_engine, "raytrace:depth=4"};
    std::printf("%s, %s\n", plain.device().name.c_str(), plain.device().driver.c_str());
    compare_two_configurations(
        "raytrace:depth=4 512x512: texel buffers, shared stack, scattered groups against "
        "storage buffers, "
        "private stack, groups in order",
        fast, naive, base, rounds);
    ComparedConfiguration layered{"six faces in one pass", plain, "parallax"},
        faces{"six passes", faces_engine, "parallax"};
    compare_two_configurations(
        "parallax 512x512: captures in layered passes against one pass a face", layered, faces,
        base, rounds);
}

/// Measures the rules that run on the processor. They are always in use, so only their time is
/// printed.
void compare_processor_rules(const session::Request& base) {
    constexpr int kRepetitions = 25;
    const render::SceneUnits space = render::make_scene_units(base.scene);
    const render::FrameGeometry geometry = render::make_geometry(base.scene, space);
    render::NearestTriangle nearest;
    nearest.set_geometry(geometry);
    volatile float kept = 0; // volatile, so that the compiler keeps the measured work
    const std::vector<benchmark::Subject> subjects{
        benchmark::make_subject("near planes from the nearest gap | frame",
                                [&] {
                                    // One search each for the camera, four captures and
                                    // the light.
                                    for (int i = 0; i < 6; ++i)
                                        kept = nearest.distance(
                                            geometry, dvec3(0.1 * i),
                                            [](std::size_t, const render::DrawRange&) {
                                                return false;
                                            });
                                }),
        benchmark::make_subject("centre and scale in doubles, then floats | frame",
                                [&] {
                                    kept = render::make_geometry(
                                               base.scene, render::make_scene_units(base.scene))
                                               .vertices.front()
                                               .position.x;
                                }),
        benchmark::make_subject("areas and normals of meshes | load", [&] {
            for (scene::Mesh mesh : base.scene.meshes) scene::repair_mesh(mesh);
        })};
    const session::UsageMeter meter(session::UsageMeter::Threads::process);
    std::printf("\n| On the processor, always | ms | when |\n|---|---:|---|\n");
    for (const measure::BenchmarkResult& found : benchmark::measure_rounds(
             subjects, meter,
             {.iterations = kRepetitions, .rounds = kRepetitions, .watcher = {}})) {
        const double ms = measure::percentile(round_costs(found, measure::CostKind::real_time), .5);
        const std::size_t bar = found.name.find('|');
        std::printf("| %s| %.3f |%s |\n", found.name.substr(0, bar).c_str(), ms,
                    found.name.substr(bar + 1).c_str());
    }
}

/// Compares the device's time of a frame with and without each rule that a row can leave out. Then
/// measures the rules on the processor, which are never left out.
void compare_culling_rules(const session::Request& base, int rounds) {
    struct TimedCullingRule {
        const char* name;
        const char* with;
        const char* without;
    };
    constexpr TimedCullingRule kTimedRules[] = {
        {"watertight triangles", "raytrace", "raytrace:without=watertight"},
        {"boxes with slack", "raytrace", "raytrace:without=box_slack"},
        {"rays start off the surface by an error bound", "raytrace",
         "raytrace:without=spawn_bound"},
        {"shadow rays end short of the light", "raytrace", "raytrace:without=shadow_end"},
        {"stable spheres", "raytrace:sphere=exact", "raytrace:sphere=exact,without=stable_sphere"},
        {"half colour saturates", "parallax", "parallax:without=saturation"},
        {"\"nothing there\" is asked for", "parallax", "parallax:without=void_test"},
        {"hit points in doubles (no rule)", "raytrace:hit=f64", "raytrace"},
        {"colour in floats (no rule)", "parallax:colour=float", "parallax"}};
    session::Engine engine({.device = test::read_wanted_device_name()});
    std::printf("%s, %s; 512x512, %d pairs\n\n", engine.device().name.c_str(),
                engine.device().driver.c_str(), rounds);
    std::printf(
        "| Rule | With | ms | Without | ms | Ratio [p05 - p95] |\n|---|---|---:|---|---:|---:|\n");
    for (const TimedCullingRule& rule : kTimedRules) {
        ComparedConfiguration with{"with", engine, rule.with},
            without{"without", engine, rule.without};
        const PairedFrameTimes pairs = measure_paired_frames(with, without, base, rounds);
        std::printf("| %s | %s | %.1f | %s | %.1f | %.3f [%.3f - %.3f] |\n", rule.name, rule.with,
                    pairs.a.median, rule.without, pairs.b.median, pairs.ratio.median,
                    pairs.ratio.p05, pairs.ratio.p95);
        std::fflush(stdout);
    }
    compare_processor_rules(base);
}

} // namespace

int main(int argc, char** argv) try {
    if (argc > 4 && std::string_view(argv[1]) == "repeats") {
        repeat_comparison_of_rows(std::max(1, std::atoi(argv[2])), {argv + 3, argv + argc});
        return 0;
    }
    const bool rules = argc > 1 && std::string_view(argv[1]) == "rules";
    const int place = rules ? 2 : 1;
    const int rounds = argc > place ? std::max(1, std::atoi(argv[place])) : 7;
    session::Request base;
    base.scene = scene::make_cornell();
    base.camera = base.scene.cameras.front();
    base.frames = 5;
    base.warmup = 3;
    rules ? compare_culling_rules(base, rounds) : compare_tree_shapes(base, rounds);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_bench: %s\n", error.what());
    return 1;
}
