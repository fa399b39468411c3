// Stress properties of mirrors that touch, shrink to nothing or are very many.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include "core/error.hpp"
#include "core/mirror_id.hpp"
#include "import/load.hpp"
#include "measure/flip.hpp"
#include "measure/masks.hpp"
#include "measure/picture.hpp"
#include "measure/statistics.hpp"
#include "scene/built_in.hpp"
#include "session/technique_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

/// Measurements in a furnace: the share of pixels darker than 1, and the brightest value.
struct FurnaceMeasurement {
    double dark = 0, brightest = 0;
};

FurnaceMeasurement measure_furnace(Bench& bench, const scene::Scene& scene,
                                   const std::string& technique, int frames) {
    session::Request request = bench.make_request(scene, technique, frames);
    request.ambient = 0;
    request.size = bench.size_at_least(128); // .0001 of the pixels is one
    const session::TechniqueResult part = bench.render_technique(request);
    FurnaceMeasurement seen;
    for (const vec3& pixel : part.hdr.pixels) {
        seen.dark += !(pixel.x >= .998f);
        seen.brightest = std::max(seen.brightest, double{pixel.x});
    }
    seen.dark /= static_cast<double>(part.hdr.pixels.size());
    if (count_nonfinite(part.hdr) > 0) seen.brightest = std::nan("");
    return seen;
}

void judge_contact(Bench& bench) {
    const std::pair<const char*, std::vector<MirrorBall>> contacts[] = {
        {"on the floor and at the wall", {{{-3, -2, 1}, 1}}},
        {"two that touch", {{{-1, 0, 1}, 1}, {{1, 0, 1}, 1}}},
        {"two that overlap", {{{-.6, 0, 1}, 1}, {{.7, .2, 1}, 1}}},
        {"one in the other", {{{0, 0, 1}, 1}, {{0, 0, 1}, .5}}}};
    for (const auto& [what, balls] : contacts) { // no surface is lit, so shadows have no effect
        const scene::Scene scene = make_white_furnace(balls);
        bench.add_case(std::string(what) + ", raytrace:depth=64: dark pixels",
                       measure_furnace(bench, scene, "raytrace:depth=64", 1).dark, .0001);
        bench.add_case(std::string(what) + ", reuse, frame 100: brightest of 1",
                       measure_furnace(bench, scene, "reuse:face=32,shadow=none", 100).brightest,
                       1.002);
        bench.add_case(std::string(what) + ", pyramid: brightest of 1",
                       measure_furnace(bench, scene, "pyramid:face=32,shadow=none", 4).brightest,
                       1.002);
    }
}

void judge_vanishing_ball(Bench& bench) {
    const scene::Scene scene = make_room(bench, 2);
    const std::size_t mirror = scene.materials.size() - 1;
    const dvec3 place(0, 0, -.3);
    const std::pair<const char*, dvec3> sizes[] = {{"radius 0", dvec3(0)},
                                                   {"radius 1e-9", dvec3(1e-9)},
                                                   {"flattened", dvec3(1e-7, 1e-7, 1e-12)}};
    for (const std::string technique : {"raytrace", "parallax", "pyramid"}) {
        const session::TechniqueResult without = bench.render_technique(scene, technique);
        for (const auto& [what, size] : sizes) {
            scene::Scene with = scene;
            add_ball(with, mirror, {place, 1});
            scene::Object gone = with.objects.back();
            gone.sphere.reset();
            for (int axis = 0; axis < 3; ++axis) gone.world_from_object[axis][axis] = size[axis];
            // The vanishing mirror is first in the list, so that it changes the numbers of all
            // other mirrors.
            with.objects.pop_back();
            with.objects.insert(with.objects.begin(), gone);
            bench.add_flip(technique + ", " + what, bench.render_technique(with, technique),
                           without, .0002);
        }
    }
}

void judge_many_mirrors(Bench& bench) {
    for (const int mirrors : {0, 1, 2, 16, 64, 1000}) {
        scene::Scene scene = make_white_furnace({});
        const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
        for (int i = 0; i < mirrors; ++i)
            add_ball(scene, mirror,
                     {{-3.5 + .7 * (i % 10), -2.5 + .5 * (i / 10 % 10), .5 * (i / 100)}, .15}, 1);
        const std::string what = std::to_string(mirrors) + " mirrors";
        try {
            const int frames = bench.has_small_pictures() ? 1 : 2;
            const session::TechniqueResult part = bench.render_technique(
                scene, "reuse:face=8,shadow=none", frames);
            bench.add_nonfinite(what, part);
            bench.add_case(what + ": passes off N + 1", std::abs(part.scene_passes - (mirrors + 1)),
                           0);
        } catch (const Error& error) {
            if (bench.ends_run(error)) throw;
            if (is_refusal(error) && mirrors == 1000)
                bench.add_skipped(what, error);
            else
                bench.add_case(what + ": refused otherwise than by a budget: " + error.what(), 1,
                               0);
        }
    }
}

void judge_face_sizes(Bench& bench) {
    const scene::Scene scene = make_room(bench, 1);
    const auto render = [&](const std::string& technique, int frames = 4) {
        session::Request request = bench.make_request(scene, technique, frames);
        request.size = bench.size_at_least(64);
        return bench.render_technique(request);
    };
    const session::TechniqueResult truth = render("raytrace");
    const measure::Mask mirrors = measure::mask_mirrors(truth.hits);
    const auto mean_of = [&](const session::TechniqueResult& part) {
        return measure::mean_of(part.hdr, measure::ValueRange::clamped, mirrors).all;
    };
    const double wanted = mean_of(truth);
    for (const char* face : {"1", "2", "3"})
        for (const std::string technique : {"reuse", "parallax", "pyramid", "layered"}) {
            const std::string text = technique + ":face=" + face;
            const session::TechniqueResult part = render(text);
            bench.add_nonfinite(text, part);
            // With captures of a few texels, it depends on chance whether a texel sees the lamp.
            const double mean = mean_of(part);
            bench.add_case(text + ": mirrors are black", mean > 0 ? 0 : 1, 0);
            bench.add_warning(text + ": factor between the mean of mirrors and that of ray tracing",
                              std::max(mean / wanted, wanted / mean), 4,
                              "mirrors are as bright or dark as the few texels that they read");
        }
    // A large capture must show the same picture as a small one. The plan of the frame states
    // whether the device has enough memory.
    const session::TechniqueResult usual = render("naive:bounces=1,face=1024", 1);
    for (const char* face : {"4096", "16384"})
        for (const std::string technique : {"naive:bounces=1,face=", "parallax:face="}) {
            const session::Request request = bench.make_request(scene, technique + face, 1);
            if (!bench.add_attempt(technique + face + " planned",
                                   [&] { bench.plan_technique(request); }))
                continue;
            if (std::stoi(face) > 4096) continue; // needs 10 GiB or more
            const session::TechniqueResult large = render(technique + face, 1);
            if (technique.starts_with("naive"))
                bench.add_flip(technique + face, large, usual, .01);
            else
                bench.add_nonfinite(technique + face, large);
        }
    bench.add_expected_error("face=32769", Failure::usage, "16384",
                             [] { session::parse_technique("parallax:face=32769"); });
}

/// Moves ball 4 through its whole path and compares adjacent frames.
void judge_moving_ball(Bench& bench) {
    constexpr int kWarmupFrames = 8, kPathFrames = 120;
    constexpr double kMotionPathSeconds = 4;
    session::Request request = bench.make_request(scene::make_cornell(),
                                                  bench.fit_captures("parallax:face=128"), 1);
    request.size = bench.size_at_least(128);
    session::Session session(bench.bench_engine(), request.scene);
    std::vector<double> steps;
    measure::Picture last;
    for (int k = 1; k <= kWarmupFrames + kPathFrames; ++k) {
        request.time = kMotionPathSeconds * (k - 1) / kPathFrames;
        const session::Frame frame = bench.render_frame(session, request);
        if (k < kWarmupFrames) continue;
        measure::Picture now = frame.read().display;
        if (k > kWarmupFrames) steps.push_back(measure::flip_mean(measure::flip(now, last)));
        last = std::move(now);
    }
    const double most = *std::ranges::max_element(steps), median = measure::summarise(steps).median;
    bench.add_case("largest FLIP from frame to frame over the median", most / median, 3);
}

void judge_parallax_correction(Bench& bench) {
    const auto contract = [&](const std::string& technique, int frames) {
        session::Request request = bench.make_request(scene::make_cornell(), technique, frames);
        request.size = {512, 512}; // ball 4 is only about 30 pixels wide at half this size
        return bench.render_technique(request);
    };
    const session::TechniqueResult truth = contract("raytrace:depth=16", 1),
                                   plain = contract("reuse", 8),
                                   corrected = contract("parallax", 8);
    const std::vector<float> no_flip(truth.hdr.pixels.size());
    const auto share = [&](const measure::Mask& mask) {
        return measure::difference(corrected.hdr, truth.hdr, mask, no_flip).rmse /
               measure::difference(plain.hdr, truth.hdr, mask, no_flip).rmse;
    };
    for (std::uint32_t ball = 1; ball <= 4; ++ball)
        bench.add_case(fmt::format("ball {}: rmse over uncorrected", ball),
                       share(measure::mask_one_mirror(truth.hits, MirrorId(ball))), .65);
    bench.add_case("together: rmse over uncorrected", share(measure::mask_mirrors(truth.hits)), .5);
}

const RegisteredProperty kParallaxCorrectionProperty{
    {"N12", "parallax against ray tracing, contract camera, 512x512",
     "better than uncorrected for every ball", judge_parallax_correction, "parallax_mirrored"}};
const RegisteredProperty kBallsInContactProperty{
    {"C1", "balls that touch wall and floor, each other, overlap, are concentric",
     "no dark ring, no blow-up in 100 frames", judge_contact, "rays_start_on_surface"}};
const RegisteredProperty kVanishingBallProperty{{"C8", "a mirror of radius 0, 1e-9, flattened",
                                                 "the others are untouched (FLIP)",
                                                 judge_vanishing_ball, "no_size_no_number"}};
const RegisteredProperty kManyMirrorsProperty{{"C9", "0, 1, 2, 16, 64, 1000 mirrors",
                                               "0: no capture; 1000: runs, or a budget message",
                                               judge_many_mirrors, "later_arrays_not_drawn"}};
const RegisteredProperty kFaceSizesProperty{
    {"C10", "face 1, 2, 3, 4096, 16384, 32769", "runs, or says the bytes, or is refused",
     judge_face_sizes, "most_of_knob_unchecked", "rendering at 16384, which is planned only"}};
const RegisteredProperty kMovingBallProperty{{"C13", "ball 4 through its whole path, 120 frames",
                                              "no single-frame pop", judge_moving_ball,
                                              "motion_ends_early"}};

} // namespace

} // namespace catoptric::stress
