// Properties of a scene's position, size and rotation: none of them may be visible.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::stress {

namespace {

constexpr const char* kCubeTechniques[] = {"reuse", "parallax", "pyramid", "hybrid"};

/// Compares the scene under each root transform with the original. `traced` is the limit for ray
/// tracing, `cubes` that for the other techniques.
void compare_through(Bench& bench, const std::vector<std::pair<std::string, dmat4>>& roots,
                     double traced, double cubes) {
    const scene::Scene scene = room(bench, 3);
    const auto with = [&](const std::string& technique, double limit) {
        const app::Part plain = bench.render(scene, technique);
        for (const auto& [what, root] : roots)
            bench.add_flip(technique + ", " + what, bench.render(through(scene, root), technique),
                           plain, limit);
    };
    with("raytrace", traced);
    for (const char* technique : kCubeTechniques) with(technique, cubes);
}

void judge_scale(Bench& bench) {
    std::vector<std::pair<std::string, dmat4>> roots;
    for (const double factor : {1e-6, 1e-3, 1e3, 1e6})
        roots.emplace_back(fmt::format("times {}", factor), scaled(factor));
    compare_through(bench, roots, .0005, .001);
}

void judge_place(Bench& bench) {
    std::vector<std::pair<std::string, dmat4>> roots;
    for (const double distance : {1e5, 1e7})
        roots.emplace_back(fmt::format("{} away", distance),
                           moved(normalize(dvec3(1, -.5, .7)) * distance));
    compare_through(bench, roots, .0005, .0005);
}

void judge_turn(Bench& bench) {
    const double angle = bench.random(.3, 2.8);
    const dvec3 axis(bench.random(-1, 1), bench.random(.2, 1), bench.random(-1, 1));
    compare_through(bench,
                    {{fmt::format("turned {:.1f} degrees", angle * 180 / 3.14159265358979),
                      turned(angle, axis)}},
                    .0005, .005);
}

/// Judges the scene and camera mirrored at the root: the picture must be mirrored.
void judge_negative(Bench& bench) {
    const scene::Scene scene = room(bench, 3);
    dmat4 root(1);
    root[0][0] = -1;
    for (const std::string technique : {"raytrace", "pyramid"}) {
        app::Part plain = bench.render(scene, technique);
        for (int y = 0; y < plain.display.height; ++y)
            for (int x = 0; x < plain.display.width / 2; ++x)
                std::swap(plain.display.at(x, y), plain.display.at(plain.display.width - 1 - x, y));
        bench.add_flip(technique + ", mirrored", bench.render(through(scene, root), technique),
                       plain, .001);
    }
}

/// Judges walls so far away that the ball is a point in comparison. Parallax correction must then
/// have no effect.
void judge_wide(Bench& bench) {
    for (const double width : {1e5, 1e6}) {
        scene::Scene scene = through(room(bench, 0), scaled(width / 4));
        const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
        add_ball(scene, mirror, {{0, 0, 0}, 1});
        scene.cameras.front() = {
            .eye = {.5, .3, -6}, .target = {0, 0, 0}, .vertical_fov_degrees = 30};
        const app::Part plain = bench.render(scene, "reuse"),
                        corrected = bench.render(scene, "parallax");
        const std::string what = fmt::format("{} wide", width);
        bench.add_nonfinite(what, corrected);
        bench.add_flip(what + ", parallax against reuse", corrected, plain, .0005);
    }
}

const Registered kScale{{"N1", "scene times 1e-6, 1e-3, 1e3, 1e6",
                         "the picture is that at 1 (FLIP)", judge_scale, "area_of_lamp_unscaled"}};
const Registered kPlace{{"N2", "scene moved by 1e5 and 1e7", "the picture is that at 0 (FLIP)",
                         judge_place, "eye_rounded_first"}};
const Registered kTurn{{"N3", "scene and camera turned by an odd angle", "the picture stays (FLIP)",
                        judge_turn, "lamp_not_turned"}};
const Registered kNegative{{"N4", "negative scale at the root",
                            "the picture is mirrored, no face is missing (FLIP)", judge_negative,
                            "order_of_corners_kept",
                            "a thousand nested nodes, which a test of files judges"}};
const Registered kWide{{"N13", "room 1e5 and 1e6 units wide around a ball of 1",
                        "finite; the correction tends to none (FLIP)", judge_wide,
                        "distance_ends_near"}};

} // namespace

} // namespace catoptric::stress
