// Tests of soft shadows of lamps from one shadow map (`soft=pcss`), against formulas for penumbrae
// and against shadow rays to many points of the lamp.
#include "measure/masks.hpp"
#include "scene/classify.hpp"
#include "scene/light.hpp"
#include "support/lit.hpp"
#include "support/rendering.hpp"
#include "support/special_values.hpp"

#include <cmath>
#include <iostream>
#include <optional>

namespace {

using namespace catoptric;

constexpr double kLampHeight = 2, kBoardHeight = 1, kHalfLampEdge = .5;
const std::string kHardRow = "naive:bounces=0,shadow_map=512", kSoftRow = kHardRow + ",soft=pcss";

/// Shape of the lamp above the board.
enum class LampShape { square, ball };

/// Returns a white floor at y = 0 below a lamp at x = 0. A board half-way between them hides the
/// side x > 0. The camera looks down from below the board.
scene::Scene make_half_hidden_lamp(LampShape shape) {
    scene::Scene scene{.name = "half-hidden lamp"};
    const std::size_t white = test::add_material(scene, {.name = "white", .albedo = vec3(1)}),
                      lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(8)});
    test::add_quad(scene, "floor", white, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4});
    test::add_quad(scene, "board", white, {0, kBoardHeight, -9}, {9, kBoardHeight, -9},
                   {9, kBoardHeight, 9}, {0, kBoardHeight, 9});
    const double h = kHalfLampEdge;
    if (shape == LampShape::square)
        test::add_quad(scene, "lamp", lamp, {-h, kLampHeight, -h}, {h, kLampHeight, -h},
                       {h, kLampHeight, h}, {-h, kLampHeight, h});
    else
        test::add_ball(scene, "lamp", lamp, {0, kLampHeight, 0}, h, 3);
    scene.cameras.push_back({.name = "below the board",
                             .eye = {0, .9, 0},
                             .target = {0, 0, 0},
                             .up = {0, 0, -1},
                             .vertical_fov_degrees = 100});
    return scene;
}

/// A point of the floor and the share of the lamp that reaches it.
struct FloorPoint {
    double x = 0, visible = 0;
};

/// Returns the visible share of the lamp along the middle row of a picture, from left to right: the
/// picture divided by the same picture without shadows.
std::vector<FloorPoint> measure_visible_shares(const scene::Scene& scene, const std::string& row) {
    constexpr int kEdge = 64;
    const uvec2 size{kEdge, kEdge};
    const measure::Picture
        shaded = test::render_without_ambient(scene, row, size).hdr,
        lit = test::render_without_ambient(scene, "naive:bounces=0,shadow=none", size).hdr;
    std::vector<FloorPoint> points;
    for (int x = 0; x < kEdge; ++x) {
        const dvec3 along = test::camera_direction_of_pixel(scene.cameras.front(), x, kEdge / 2,
                                                            kEdge);
        points.push_back({-.9 * along.x / along.y,
                          double{shaded.at(x, kEdge / 2).x} / double{lit.at(x, kEdge / 2).x}});
    }
    return points;
}

/// Returns where the visible share first falls below `share`, from left to right, by linear
/// interpolation.
double find_place_of_share(const std::vector<FloorPoint>& points, double share) {
    for (std::size_t i = 1; i < points.size(); ++i)
        if (points[i].visible < share)
            return points[i - 1].x + (points[i].x - points[i - 1].x) *
                                         (points[i - 1].visible - share) /
                                         (points[i - 1].visible - points[i].visible);
    ADD_FAILURE() << "no visible share below " << share;
    return 0;
}

/// The board is half-way, so a point at x sees the part of the lamp left of -x. The penumbra is as
/// wide as the lamp.
TEST(SoftShadow, PenumbraOfASquareLampHasTheAnalyticWidth) {
    const std::vector<FloorPoint> points = measure_visible_shares(
        make_half_hidden_lamp(LampShape::square), kSoftRow);
    double most = 0;
    for (const FloorPoint& point : points) {
        const double wanted = std::clamp((kHalfLampEdge - point.x) / (2 * kHalfLampEdge), 0., 1.);
        most = std::max(most, std::abs(point.visible - wanted));
        if (std::abs(point.x) < kHalfLampEdge + .03) continue; // the four taps of a look-up
        EXPECT_EQ(point.visible, point.x < 0 ? 1 : 0) << point.x;
    }
    const double width = (find_place_of_share(points, .1) - find_place_of_share(points, .9)) / .8;
    std::cout << "[ MEASURED ] penumbra " << width << " wide of 1; visible share off by at most "
              << most << '\n';
    EXPECT_NEAR(width, 2 * kHalfLampEdge, .06);
    EXPECT_LT(most, .05);
}

/// A ball shows a disc. The part of a disc left of the line at -x is 1/2 - (a + s c) / pi, where
/// s = x / r is the sine of a, and c its cosine.
TEST(SoftShadow, PenumbraOfABallIsThatOfADisc) {
    const std::vector<FloorPoint> points = measure_visible_shares(
        make_half_hidden_lamp(LampShape::ball), kSoftRow);
    double most = 0;
    for (const FloorPoint& point : points) {
        const double sine = std::clamp(point.x / kHalfLampEdge, -1., 1.), angle = std::asin(sine);
        most = std::max(
            most, std::abs(point.visible - .5 + (angle + sine * std::cos(angle)) / test::kPi));
    }
    std::cout << "[ MEASURED ] visible share of a ball off by at most " << most << '\n';
    EXPECT_LT(most, .08);
}

/// Rays to 64 points of the lamp are nearer to the soft shadow than to the hard one.
TEST(SoftShadow, ErrorIsSmallerThanThatOfHardShadows) {
    scene::Scene scene = test::make_yard_scene();
    const std::size_t lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(25)});
    test::add_quad(scene, "lamp", lamp, {-.3, 2.2, -.3}, {.3, 2.2, -.3}, {.3, 2.2, .3},
                   {-.3, 2.2, .3});
    const uvec2 size{64, 64};
    const measure::Picture hard = test::render_without_ambient(scene, kHardRow, size).hdr,
                           soft = test::render_without_ambient(scene, kSoftRow, size).hdr;
    scene.light_samples = 64;
    const measure::Picture truth = test::render_without_ambient(scene, "raytrace", size).hdr;
    const double of_hard = test::rmse_of_pictures(hard, truth),
                 of_soft = test::rmse_of_pictures(soft, truth);
    std::cout << "[ MEASURED ] rmse of hard shadows " << of_hard << ", of soft " << of_soft << '\n';
    EXPECT_LT(of_soft, .6 * of_hard);
}

/// Returns the half-hidden lamp with a mirror on the floor's left side that faces the penumbra.
scene::Scene make_mirrored_penumbra(bool is_flat) {
    scene::Scene scene = make_half_hidden_lamp(LampShape::square);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    if (is_flat)
        test::add_quad(scene, "mirror", mirror, {-1, 0, 1}, {-1, 0, -1}, {-1, .8, -1}, {-1, .8, 1});
    else
        test::add_ball(scene, "mirror", mirror, {-1, .3, 0}, .3, 4);
    scene.cameras.front() = {.name = "at the mirror",
                             .eye = {.6, .6, 0},
                             .target = {-1, .3, 0},
                             .vertical_fov_degrees = 60};
    scene::find_mirrors(scene);
    return scene;
}

/// Captures and mirrored views are lit as the picture is.
TEST(SoftShadow, MirrorsShowSoftShadows) {
    const uvec2 size{48, 48};
    for (const bool is_flat : {true, false}) {
        scene::Scene scene = make_mirrored_penumbra(is_flat);
        const std::string row = is_flat ? "planar:shadow_map=512" : "secant:shadow_map=512";
        const measure::Picture hard = test::render_without_ambient(scene, row, size).hdr,
                               soft = test::render_without_ambient(scene, row + ",soft=pcss", size)
                                          .hdr;
        scene.light_samples = 64;
        const session::TechniqueResult truth = test::render_without_ambient(scene, "raytrace",
                                                                            size);
        const measure::Mask mirrors = measure::mask_mirrors(truth.hits);
        const double of_hard = test::rmse_of_pictures(hard, truth.hdr, mirrors),
                     of_soft = test::rmse_of_pictures(soft, truth.hdr, mirrors);
        std::cout << "[ MEASURED ] " << row << ": rmse over mirrors with hard shadows " << of_hard
                  << ", with soft " << of_soft << '\n';
        EXPECT_LT(of_soft, of_hard / 2) << row;
    }
}

TEST(SoftShadow, NoneIsTheDefault) {
    const scene::Scene room = test::make_lit_room(1, 1);
    const uvec2 size{32, 24};
    const measure::Picture by_default = test::render_technique(room, "secant:face=32", size).hdr;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        test::render_technique(room, "secant:face=32,soft=none", size).hdr, by_default));
    EXPECT_FALSE(test::have_equal_pixel_bytes(
        test::render_technique(room, "secant:face=32,soft=pcss", size).hdr, by_default));
}

TEST(SoftShadow, LightsWithoutASurfaceStayHard) {
    scene::Scene scene = test::make_yard_scene();
    scene::PunctualLight light{.intensity = vec3(9)};
    light.world_from_light[3] = dvec4(.5, 2, 1, 1);
    scene.punctual.push_back(light);
    light.kind = scene::PunctualLight::Kind::directional;
    light.world_from_light = test::make_light_transform({0, 3, 0}, {.3, -1, .2});
    scene.punctual.push_back(light);
    const uvec2 size{32, 32};
    const measure::Picture hard = test::render_without_ambient(scene, kHardRow, size).hdr;
    EXPECT_TRUE(test::have_equal_pixel_bytes(
        test::render_without_ambient(scene, kSoftRow, size).hdr, hard));
    // Beside a lamp that is too weak to change a byte, the shader for soft shadows draws them.
    test::add_quad(scene, "lamp",
                   test::add_material(scene, {.name = "lamp", .emission = vec3(1e-30f)}),
                   {-.3, 3, -.3}, {.3, 3, -.3}, {.3, 3, .3}, {-.3, 3, .3});
    EXPECT_LT(test::rmse_of_pictures(test::render_without_ambient(scene, kSoftRow, size).hdr,
                                     test::render_without_ambient(scene, kHardRow, size).hdr),
              1e-6);
}

/// A flat surface must not shade itself, however flat the light comes in and however large the lamp
/// is.
TEST(SoftShadow, SurfacesDoNotShadeThemselves) {
    for (const double height : {.05, .3, 2.}) {
        scene::Scene scene = test::make_floor_scene();
        const std::size_t grey = scene.objects.front().material;
        test::add_ball(scene, "ball", grey, {.9, .3, -.5}, .3, 4);
        // Because of the cellar, the floor is no backdrop, so it is in the shadow map.
        test::add_quad(scene, "cellar", grey, {-2, -1, 2}, {2, -1, 2}, {2, -1, -2}, {-2, -1, -2});
        test::add_quad(
            scene, "lamp", test::add_material(scene, {.name = "lamp", .emission = vec3(9)}),
            {-.9, height, -.4}, {-.1, height, -.4}, {-.1, height, .4}, {-.9, height, .4});
        scene.cameras.push_back({.name = "above",
                                 .eye = {0, 4, 0},
                                 .target = {0, 0, 0},
                                 .up = {0, 0, -1},
                                 .vertical_fov_degrees = 50});
        const uvec2 size{48, 48};
        const measure::Picture
            soft = test::render_without_ambient(scene, kSoftRow, size).hdr,
            lit = test::render_without_ambient(scene, "naive:bounces=0,shadow=none", size).hdr;
        // Left of the lamp no shadow falls on the floor.
        for (int y = 0; y < soft.height; ++y)
            for (int x = 0; x < soft.width / 4; ++x)
                EXPECT_EQ(soft.at(x, y), lit.at(x, y)) << height << ": " << x << "," << y;
    }
}

TEST(SoftShadow, HalfAxesOfALampFollowFromItsArea) {
    const auto find_half_axes = [](const scene::Scene& scene) {
        return scene::list_lights(scene).front().half_axes;
    };
    scene::Scene scene = make_half_hidden_lamp(LampShape::square);
    const dmat3 square = find_half_axes(scene);
    EXPECT_NEAR(glm::length(square[0]), kHalfLampEdge, 1e-6);
    EXPECT_NEAR(glm::length(square[1]), kHalfLampEdge, 1e-6);
    EXPECT_NEAR(glm::length(square[2]), 0, 1e-6);
    EXPECT_NEAR(square[0].y, 0, 1e-6);
    scene.light_samples = 16;
    EXPECT_NEAR(glm::length(find_half_axes(scene)[0]), kHalfLampEdge / 4, 1e-6);
    // The disc that a ball shows has the variance r^2 / 4.
    const dmat3 ball = find_half_axes(make_half_hidden_lamp(LampShape::ball));
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(glm::length(ball[axis]), std::sqrt(.75) * kHalfLampEdge, .01);
}

} // namespace
