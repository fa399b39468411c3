// Stress properties of light between mirrors: light never grows, each mirror reduces it by its
// reflectance, and it arrives bounce by bounce.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

const std::vector<MirrorBall> kTwoMirrorBalls{{{-1.2, -.3, 1}, 1}, {{1.3, .4, 1.5}, 1.2}};

session::TechniqueResult render_without_ambient(Bench& bench, const scene::Scene& scene,
                                                const std::string& technique, int frames) {
    session::Request request = bench.make_request(scene, bench.fit_captures(technique), frames);
    request.ambient = 0;
    return bench.render_technique(request);
}

void judge_white_furnace(Bench& bench) {
    const scene::Scene scene = make_white_furnace(kTwoMirrorBalls);
    for (const session::TechniqueInfo& technique : session::techniques())
        bench.add_case(
            technique.name + ": brightest of 1",
            brightest_channel(render_without_ambient(bench, scene, technique.name, 8).hdr), 1.002);
    for (int bounces = 0; bounces <= 8; bounces += 4) {
        const std::string text = "naive:bounces=" + std::to_string(bounces);
        bench.add_case(text + ": brightest of 1",
                       brightest_channel(render_without_ambient(bench, scene, text, 1).hdr), 1.002);
    }
    double darkest = 1;
    for (const vec3& pixel :
         render_without_ambient(bench, scene, "raytrace:depth=16", 1).hdr.pixels)
        darkest = std::min(darkest, double{pixel.x});
    bench.add_case("raytrace:depth=16: missing from 1", 1 - darkest, .002);
}

/// Judges techniques with captures in a corridor of two mirrors. A capture sees the opposite mirror
/// from one place only. A pixel may therefore show another number of reflections than ray tracing,
/// which counts as a loss of quality and not as an error. Additional light would be an error.
void judge_corridor_captures(Bench& bench, const scene::Scene& scene) {
    const session::TechniqueResult truth = render_without_ambient(bench, scene, "raytrace:depth=16",
                                                                  1);
    for (const std::string technique :
         {"reuse", "parallax", "secant:continue=8", "march:continue=8", "pyramid:continue=8",
          "layered:continue=8", "hybrid:continue=8"}) {
        const session::TechniqueResult part = render_without_ambient(bench, scene, technique, 8);
        std::size_t off = 0;
        for (std::size_t i = 0; i < part.hdr.pixels.size(); ++i)
            off += !(std::abs(part.hdr.pixels[i].x - truth.hdr.pixels[i].x) <=
                     .005f * truth.hdr.pixels[i].x);
        bench.add_case(technique + ": brightest of 1", brightest_channel(part.hdr), 1.002);
        bench.add_warning(technique + ": share of pixels off .8^k",
                          double(off) / double(part.hdr.pixels.size()), .005,
                          "a mirror in a mirror shows another number of reflections than "
                          "there are");
    }
}

/// Judges the pixels that show up to `depth` mirrors in a row. Pixels that would show more mirrors
/// are black.
void judge_corridor_depth(Bench& bench, const scene::Scene& scene, const std::string& technique,
                          int depth) {
    double worst = 0;
    std::vector<std::size_t> seen(static_cast<std::size_t>(depth) + 1);
    for (const vec3& pixel : render_without_ambient(bench, scene, technique, 1).hdr.pixels) {
        if (pixel.x == 0) continue;
        const auto k = static_cast<std::size_t>(
            std::max(std::lround(std::log(double{pixel.x}) / std::log(.8)), 0L));
        worst = std::max(worst, std::abs(pixel.x / std::pow(.8, double(k)) - 1));
        if (k <= static_cast<std::size_t>(depth))
            ++seen[k];
        else
            worst = 1;
    }
    bench.add_case(technique + ": off .8^k", worst, .005);
    if (depth <= 4)
        bench.add_case(technique + ": k that nobody shows", double(std::ranges::count(seen, 0u)),
                       0);
}

/// Judges two mirrors that face each other in a box that emits 1. A path of k mirrors shows .8^k.
void judge_mirror_corridor(Bench& bench) {
    scene::Scene scene = make_white_furnace({});
    const std::size_t mirror = add_material(
        scene, {.name = "mirror", .mirror = true, .reflectance = vec3(.8f)});
    add_quad(scene, mirror, {-2, -2, -2}, {-2, -2, 4}, {-2, 2, 4}, {-2, 2, -2});
    add_quad(scene, mirror, {2, -2, -2}, {2, 2, -2}, {2, 2, 4}, {2, -2, 4});
    scene.cameras.front() = {
        .eye = {0, 0, -1.9}, .target = {1.9, .1, -1.2}, .vertical_fov_degrees = 60};
    for (const int depth : {1, 4, 12})
        for (const char* row : {"raytrace:depth=", "planar:bounces="})
            judge_corridor_depth(bench, scene, row + std::to_string(depth), depth);
    judge_corridor_captures(bench, scene);
}

void judge_reuse_energy(Bench& bench) {
    const scene::Scene scene = make_room(bench, 3);
    for (int k = 1; k <= 8; ++k)
        bench.add_case(
            fmt::format("frame {}: pixels that differ", k),
            double(count_different(
                bench.render_technique(scene, "reuse:face=64", k).hdr,
                bench.render_technique(scene, fmt::format("naive:face=64,bounces={}", k), 1).hdr)),
            0);
}

void judge_pass_counts(Bench& bench) {
    for (const int balls : {0, 1, 4}) {
        const scene::Scene scene = make_room(bench, balls);
        for (const int bounces : {0, 1, 3})
            bench.add_case(
                fmt::format("{} mirrors, {} bounces: off N i + 2", balls, bounces),
                std::abs(bench
                             .render_technique(scene,
                                               fmt::format("naive:face=16,bounces={}", bounces), 1)
                             .scene_passes -
                         (balls * bounces + 2)),
                0);
        bench.add_case(
            fmt::format("{} mirrors: off N + 2", balls),
            std::abs(bench.render_technique(scene, "reuse:face=16", 2).scene_passes - (balls + 2)),
            0);
    }
}

const RegisteredProperty kFurnaceProperty{{"N6", "white furnace, bounces 0..8, every technique",
                                           "energy is never created; complete at depth 16",
                                           judge_white_furnace, "traced_added"}};
const RegisteredProperty kCorridorProperty{{"N7", "parallel mirrors, reflectance .8, depth 1..12",
                                            "k mirrors show .8^k, nothing after the depth",
                                            judge_mirror_corridor, "one_mirror_too_many"}};
const RegisteredProperty kReuseEnergyProperty{{"N9", "static scene, reuse frame k",
                                               "equals naive with k bounces", judge_reuse_energy,
                                               "history_black"}};
const RegisteredProperty kPassCountsProperty{{"N10", "mirrors N, bounces i",
                                              "scene passes N i + 2 and N + 2", judge_pass_counts,
                                              "naive_once_more"}};

} // namespace

} // namespace catoptric::stress
