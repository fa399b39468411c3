// Tests of render::find_shown_faces, which finds the objects that each face of a capture
// shows.
#include "render/shown_faces.hpp"

#include "core/shader_math.hpp"
#include "render/enclosure.hpp"
#include "render/nearest.hpp"
#include "render/space.hpp"
#include "render/views.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace {

using namespace catoptric;

/// A scene whose geometry and inner balls are ready for captures.
struct CapturedScene {
    scene::Scene scene{.name = "balls"};
    render::FrameGeometry geometry;
    std::vector<render::InnerBall> balls;

    std::size_t add_mirror_ball(double radius, const dvec3& centre, int halvings) {
        if (scene.materials.empty()) test::add_material(scene, {.name = "mirror", .mirror = true});
        test::add_ball(scene, "ball", 0, centre, radius, halvings);
        return scene.objects.size() - 1;
    }
    /// Adds three balls in a row on the x axis, the first at the origin, and finishes.
    void add_row_of_balls() {
        for (const double x : {0., 2., 4.}) add_mirror_ball(.3, {x, 0, 0}, 3);
        finish_scene();
    }
    void finish_scene() {
        geometry = render::make_geometry(scene, render::make_scene_units(scene));
        render::NearestTriangle nearest;
        nearest.set_geometry(geometry);
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
            ASSERT_TRUE(render::is_closed_shell(scene.meshes[scene.objects[i].mesh]));
            const vec3 centre = geometry.ranges[i].bounds.centre();
            balls.push_back({centre,
                             nearest.distance(geometry, dvec3(centre),
                                              [&](std::size_t object, const render::DrawRange&) {
                                                  return object != i;
                                              }),
                             i});
        }
    }
    std::vector<shared::View> make_capture_views(std::size_t object) const {
        return render::make_cube_views(geometry.ranges[object].bounds.centre(), .001f);
    }
    /// Returns, for each object, the faces that show it in the capture around the given object.
    std::vector<std::uint8_t> faces_showing_objects_around(std::size_t object,
                                                           std::uint32_t edge) const {
        return render::find_shown_faces(make_capture_views(object), {edge, 8}, geometry.ranges,
                                        balls, [&](std::size_t i) { return i != object; });
    }
    /// Returns the object, other than `except`, whose triangles a ray meets first.
    std::optional<std::size_t> find_first_object_of_ray(const vec3& eye, const vec3& direction,
                                                        std::size_t except) const {
        double least = std::numeric_limits<double>::infinity();
        std::optional<std::size_t> first;
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
            const render::DrawRange& range = geometry.ranges[i];
            for (std::uint32_t k = 0; i != except && k < range.index_count; k += 3) {
                const auto corner = [&](std::uint32_t j) {
                    return dvec3(
                        geometry.vertices[geometry.indices[range.first_index + k + j]].position);
                };
                const dvec3 a = corner(0), ab = corner(1) - a, ac = corner(2) - a;
                const dvec3 across = cross(dvec3(direction), ac), from = dvec3(eye) - a;
                const double size = dot(ab, across), u = dot(from, across) / size;
                const dvec3 turned = cross(from, ab);
                const double v = dot(dvec3(direction), turned) / size, t = dot(ac, turned) / size;
                if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < least) least = t, first = i;
            }
        }
        return first;
    }
};

/// Returns a cube of n^3 mirror balls. The balls keep their size relative to their distances.
CapturedScene make_lattice_of_balls(int n) {
    CapturedScene scene;
    for (int k = 0; k < n * n * n; ++k) {
        const dvec3 cell(k % n, k / n % n, k / n / n);
        const auto off = [&](int axis) { return .06 * std::sin(7 * k + axis); };
        scene.add_mirror_ball(.32, cell + dvec3(off(0), off(1), off(2)), 3);
    }
    scene.finish_scene();
    return scene;
}

/// Returns how many objects a capture of the scene shows, on average over all captures.
double mean_shown_objects(const CapturedScene& scene, std::uint32_t edge) {
    std::size_t shown = 0;
    for (std::size_t i = 0; i < scene.balls.size(); ++i)
        for (const std::uint8_t faces : scene.faces_showing_objects_around(i, edge))
            shown += faces != 0;
    return static_cast<double>(shown) / static_cast<double>(scene.balls.size());
}

TEST(ShownFaces, EveryObjectThatATexelShowsIsDrawn) {
    test::RandomNumbers numbers(5);
    std::size_t left_out = 0;
    for (int round = 0; round < 8; ++round) {
        CapturedScene scene;
        for (int i = 0; i < 40; ++i)
            scene.add_mirror_ball(numbers.random_number_between(.02f, .3f),
                                  dvec3(2.f * numbers.random_point_in_cube()), round % 3);
        scene.finish_scene();
        // With 72 texels an edge, a cell holds several texels.
        const std::uint32_t edge = round % 2 == 0 ? 9 : 72;
        const std::vector<shared::View> views = scene.make_capture_views(0);
        const std::vector<std::uint8_t> shown = scene.faces_showing_objects_around(0, edge);
        for (const std::uint8_t faces : shown) left_out += faces == 0;
        for (int face = 0; face < 6; ++face)
            for (std::uint32_t y = 0; y < edge; y += edge / 9)
                for (std::uint32_t x = 0; x < edge; x += edge / 9) {
                    const auto slope = [&](std::uint32_t texel) {
                        return (static_cast<float>(texel) + .5f) / static_cast<float>(edge) * 2 - 1;
                    };
                    const vec3 direction = f32::cube_direction(face, {slope(x), slope(y), 1});
                    const auto object = scene.find_first_object_of_ray(
                        views[static_cast<std::size_t>(face)].eye, direction, 0);
                    if (!object) continue;
                    EXPECT_TRUE(shown[*object] >> face & 1) << "object " << *object;
                }
    }
    EXPECT_GT(left_out, 8u * 4);
}

TEST(ShownFaces, ABallBehindAnotherIsNotDrawn) {
    CapturedScene scene;
    scene.add_mirror_ball(.3, {0, 0, 0}, 3);
    scene.add_mirror_ball(.3, {2, 0, 0}, 3);
    scene.add_mirror_ball(.3, {4, 0, 0}, 3); // behind the second ball
    scene.add_mirror_ball(.3, {4, 1.5, 0}, 3);
    scene.finish_scene();
    const std::vector<std::uint8_t> shown = scene.faces_showing_objects_around(0, 64);
    EXPECT_EQ(shown, (std::vector<std::uint8_t>{0, 1, 0, 1}));
}

TEST(ShownFaces, AnObjectBetweenTexelCentresIsNotDrawn) {
    CapturedScene scene;
    scene.add_mirror_ball(.3, {0, 0, 0}, 3);
    scene.add_mirror_ball(.01, {4, 0, 0}, 3); // the mirror is at a corner of four texels
    scene.add_mirror_ball(.01, {4, .25, .25}, 3);
    scene.finish_scene();
    EXPECT_EQ(scene.faces_showing_objects_around(0, 16), (std::vector<std::uint8_t>{0, 0, 1}));
}

TEST(ShownFaces, AnObjectThatIsNotDrawnHidesNothing) {
    CapturedScene scene;
    scene.add_row_of_balls();
    const std::vector<std::uint8_t> shown = render::find_shown_faces(
        scene.make_capture_views(0), {64}, scene.geometry.ranges, scene.balls,
        [](std::size_t object) { return object == 2; });
    EXPECT_EQ(shown, (std::vector<std::uint8_t>{0, 0, 1}));
}

TEST(ShownFaces, AnObjectThatTheNearPlaneCutsHidesNothing) {
    CapturedScene scene;
    scene.add_row_of_balls();
    std::vector<shared::View> views = scene.make_capture_views(0);
    for (shared::View& view : views)
        view.near = length(scene.geometry.ranges[1].bounds.centre() - view.eye);
    const std::vector<std::uint8_t> shown = render::find_shown_faces(
        views, {64}, scene.geometry.ranges, scene.balls,
        [](std::size_t object) { return object > 0; });
    EXPECT_EQ(shown[2], 1);
}

// In the larger lattice, nearer balls hide most of the added ones. Before objects were left out,
// each capture drew all 63 or 215 other balls.
TEST(ShownFaces, CapturesAmongManyBallsDrawFewerThanAll) {
    const double of_64 = mean_shown_objects(make_lattice_of_balls(4), 32),
                 of_216 = mean_shown_objects(make_lattice_of_balls(6), 32);
    RecordProperty("of_64", std::to_string(of_64));
    RecordProperty("of_216", std::to_string(of_216));
    EXPECT_LT(of_64, .9 * 63);
    EXPECT_LT(of_216, .7 * 215);
    EXPECT_LT(std::log(of_216 / of_64) / std::log(216. / 64), .9);
}

} // namespace
