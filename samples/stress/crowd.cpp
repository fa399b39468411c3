// Stress property of more mirrors than one array of captures can hold: each mirror must show its
// own surroundings.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include "measure/masks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::stress {

namespace {

constexpr int kBallsPerEdge =
    20; // balls along an edge; an array of 2048 layers holds 341 of all 400
constexpr uvec2 kCrowdPictureSize{256, 256};

/// Returns a ball's colour. Two colours differ by more than 3 % in a channel.
vec3 choose_ball_colour(int ball) {
    const auto step = [](int i) { return .4f + .6f * float(i) / (kBallsPerEdge - 1); };
    return {step(ball % kBallsPerEdge), step(ball / kBallsPerEdge), .7f};
}

/// Returns balls in cells of one colour each, open to the front and the back. There is no light:
/// with an ambient light of 1, a wall shows its colour.
scene::Scene make_box_room() {
    constexpr double kHalfWallCellWidth = .48, kCellFront = -.3, kCellBack = .8;
    scene::Scene scene{.name = "cells"};
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
    for (int i = 0; i < kBallsPerEdge * kBallsPerEdge; ++i) {
        const dvec3 centre(i % kBallsPerEdge - (kBallsPerEdge - 1) / 2.0,
                           i / kBallsPerEdge - (kBallsPerEdge - 1) / 2.0, 0);
        const std::size_t wall = add_material(scene,
                                              {.name = "wall", .albedo = choose_ball_colour(i)});
        const dvec3 lo = centre + dvec3(-kHalfWallCellWidth, -kHalfWallCellWidth, kCellFront),
                    hi = centre + dvec3(kHalfWallCellWidth, kHalfWallCellWidth, kCellBack);
        for (const int axis : {0, 1})
            for (const dvec3& at : {lo, hi}) {
                dvec3 a = lo, c = hi;
                a[axis] = c[axis] = at[axis];
                dvec3 b = a, d = c;
                b.z = c.z, d.z = a.z;
                add_quad(scene, wall, a, b, c, d);
            }
        add_ball(scene, mirror, {centre, .35}, 2);
    }
    scene.cameras.push_back({.eye = {0, 0, -40}, .target = {0, 0, 0}, .vertical_fov_degrees = 29});
    return scene;
}

/// Adds the number of mirrors in which no pixel shows the colour of their own cell.
void judge_mirror_cells(Bench& bench) {
    const scene::Scene scene = make_box_room();
    std::vector<std::uint32_t> hits;
    std::vector<std::string> techniques{"raytrace:depth=1", "reuse:face=8"};
    if (!bench.has_small_pictures()) techniques.push_back("parallax:face=8");
    for (const std::string& technique : techniques) {
        session::Request request = bench.make_request(scene, technique, 1);
        request.size = kCrowdPictureSize;
        request.ambient = 1;
        const session::TechniqueResult part = bench.render_technique(request);
        if (hits.empty()) hits = part.hits;
        std::vector<int> own(std::size_t{kBallsPerEdge} * kBallsPerEdge);
        for (std::size_t i = 0; i < hits.size(); ++i) {
            const auto mirror = measure::first_mirror(hits[i]).number();
            if (mirror == 0) continue;
            const vec3 off = abs(
                part.hdr.pixels[i] / choose_ball_colour(static_cast<int>(mirror) - 1) - vec3(1));
            own[mirror - 1] += std::max({off.x, off.y, off.z}) <= .002f;
        }
        bench.add_nonfinite(technique, part);
        bench.add_case(fmt::format("{}: mirrors of {} in which no pixel shows what is around them",
                                   technique, own.size()),
                       double(std::ranges::count(own, 0)), 0);
    }
}

const RegisteredProperty kMirrorCellsProperty{
    {"C14", "400 mirrors, each in a cell of another colour", "each shows its own cell",
     judge_mirror_cells, "first_array_only"}};

} // namespace

} // namespace catoptric::stress
