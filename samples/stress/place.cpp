// Stress properties of a scene's position, size and rotation: none of them may change the picture
// visibly.
#include "stress/property.hpp"
#include "stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::stress {

namespace {

constexpr const char* kCaptureTechniques[] = {"reuse", "parallax", "pyramid", "hybrid"};

/// Compares the picture of the scene under each root transform with the picture of the original
/// scene. `traced` is the error limit of ray tracing, and `cubes` is the limit of all other
/// techniques.
void compare_transforms(Bench& bench, const std::vector<std::pair<std::string, dmat4>>& roots,
                        double traced, double cubes) {
    const scene::Scene scene = make_room(bench, 3);
    const auto with = [&](const std::string& technique, double limit) {
        const session::TechniqueResult plain = bench.render_technique(scene, technique);
        for (const auto& [what, root] : roots)
            bench.add_flip(technique + ", " + what,
                           bench.render_technique(transform_scene(scene, root), technique), plain,
                           limit);
    };
    with("raytrace", traced);
    for (const char* technique : kCaptureTechniques) with(technique, cubes);
}

void judge_scene_scale(Bench& bench) {
    std::vector<std::pair<std::string, dmat4>> roots;
    for (const double factor : {1e-6, 1e-3, 1e3, 1e6})
        roots.emplace_back(fmt::format("times {}", factor), scale_matrix(factor));
    compare_transforms(bench, roots, .0005, .001);
}

void judge_scene_position(Bench& bench) {
    std::vector<std::pair<std::string, dmat4>> roots;
    for (const double distance : {1e5, 1e7})
        roots.emplace_back(fmt::format("{} away", distance),
                           translation_matrix(normalize(dvec3(1, -.5, .7)) * distance));
    compare_transforms(bench, roots, .0005, .0005);
}

void judge_scene_rotation(Bench& bench) {
    const double angle = bench.random(.3, 2.8);
    const dvec3 axis(bench.random(-1, 1), bench.random(.2, 1), bench.random(-1, 1));
    compare_transforms(bench,
                       {{fmt::format("turned {:.1f} degrees", angle * 180 / 3.14159265358979),
                         rotation_matrix(angle, axis)}},
                       .0005, .005);
}

/// Judges the scene and camera mirrored at the root: the picture must be mirrored.
void judge_mirrored_scene(Bench& bench) {
    const scene::Scene scene = make_room(bench, 3);
    dmat4 root(1);
    root[0][0] = -1;
    for (const std::string technique : {"raytrace", "pyramid"}) {
        session::TechniqueResult plain = bench.render_technique(scene, technique);
        for (int y = 0; y < plain.display.height; ++y)
            for (int x = 0; x < plain.display.width / 2; ++x)
                std::swap(plain.display.at(x, y), plain.display.at(plain.display.width - 1 - x, y));
        bench.add_flip(technique + ", mirrored",
                       bench.render_technique(transform_scene(scene, root), technique), plain,
                       .001);
    }
}

/// Judges walls so far away that the ball is a point in comparison. Parallax correction must then
/// have no effect.
void judge_distant_walls(Bench& bench) {
    for (const double width : {1e5, 1e6}) {
        scene::Scene scene = transform_scene(make_room(bench, 0), scale_matrix(width / 4));
        const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true});
        add_ball(scene, mirror, {{0, 0, 0}, 1});
        scene.cameras.front() = {
            .eye = {.5, .3, -6}, .target = {0, 0, 0}, .vertical_fov_degrees = 30};
        const session::TechniqueResult plain = bench.render_technique(scene, "reuse"),
                                       corrected = bench.render_technique(scene, "parallax");
        const std::string what = fmt::format("{} wide", width);
        bench.add_nonfinite(what, corrected);
        bench.add_flip(what + ", parallax against reuse", corrected, plain, .0005);
    }
}

const RegisteredProperty kSceneScaleProperty{{"N1", "scene times 1e-6, 1e-3, 1e3, 1e6",
                                              "the picture is that at 1 (FLIP)", judge_scene_scale,
                                              "area_of_lamp_unscaled"}};
const RegisteredProperty kScenePositionProperty{{"N2", "scene moved by 1e5 and 1e7",
                                                 "the picture is that at 0 (FLIP)",
                                                 judge_scene_position, "eye_rounded_first"}};
const RegisteredProperty kSceneRotationProperty{{"N3", "scene and camera turned by an odd angle",
                                                 "the picture stays (FLIP)", judge_scene_rotation,
                                                 "lamp_not_turned"}};
const RegisteredProperty kMirroredSceneProperty{
    {"N4", "negative scale at the root", "the picture is mirrored, no face is missing (FLIP)",
     judge_mirrored_scene, "order_of_corners_kept",
     "a thousand nested nodes, which a test of files judges"}};
const RegisteredProperty kDistantWallsProperty{
    {"N13", "room 1e5 and 1e6 units wide around a ball of 1",
     "finite; the correction tends to none (FLIP)", judge_distant_walls, "distance_ends_near"}};

} // namespace

} // namespace catoptric::stress
