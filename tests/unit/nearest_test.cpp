// Compares render::NearestTriangle, which searches trees for the nearest triangle, with a
// search of all triangles.
#include "render/nearest.hpp"
#include "scene/built_in.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

using Skip = std::function<bool(std::size_t, const render::DrawRange&)>;

float nearest_distance_by_search(const render::FrameGeometry& geometry, const vec3& point,
                                 const Skip& skip) {
    float squared = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const render::DrawRange& range = geometry.ranges[i];
        if (skip(i, range)) continue;
        for (std::uint32_t k = 0; k < range.index_count; k += 3) {
            const auto corner = [&](std::uint32_t j) {
                return geometry.vertices[geometry.indices[range.first_index + k + j]].position;
            };
            squared = std::min(squared,
                               render::squared_distance(point, corner(0), corner(1), corner(2)));
        }
    }
    return std::sqrt(squared);
}

/// Expects the same distance from `nearest` and from a search of all triangles. Asks for random
/// points, and for the centre of each object without the triangles of that object.
void expect_nearest_as_by_search(render::NearestTriangle& nearest,
                                 const render::FrameGeometry& geometry,
                                 test::RandomNumbers& numbers) {
    for (int k = 0; k < 100; ++k) {
        const vec3 point = numbers.random_point_in_cube();
        const Skip none = [](std::size_t, const render::DrawRange&) { return false; };
        ASSERT_EQ(nearest.distance(geometry, dvec3(point), none),
                  nearest_distance_by_search(geometry, point, none));
    }
    for (std::size_t object = 0; object < geometry.ranges.size(); ++object) {
        const vec3 point = geometry.ranges[object].bounds.centre();
        const Skip own = [&](std::size_t i, const render::DrawRange&) { return i == object; };
        ASSERT_EQ(nearest.distance(geometry, dvec3(point), own),
                  nearest_distance_by_search(geometry, point, own));
    }
}

TEST(Nearest, NearestDistanceEqualsThatOfAFullSearchAlsoAfterMoves) {
    for (const scene::Scene& scene : {scene::make_cornell(), test::make_lit_room(3, 2)}) {
        const render::SceneUnits space = render::make_scene_units(scene);
        scene::Scene now = scene::scene_at(scene, 0);
        render::FrameGeometry geometry = render::make_geometry(now, space);
        render::NearestTriangle nearest;
        nearest.set_geometry(geometry);
        test::RandomNumbers numbers(1);
        expect_nearest_as_by_search(nearest, geometry, numbers);
        for (int k = 0; k < 4; ++k) {
            const std::size_t object = numbers.random_integer_below(now.objects.size());
            now.objects[object].world_from_object[3] += dvec4(
                dvec3(numbers.random_point_in_cube()) * (.1 / space.scale), 0);
            render::move_object(geometry, now, space, object);
            nearest.record_move(object);
            expect_nearest_as_by_search(nearest, geometry, numbers);
        }
    }
}

/// The distance from a point to many small balls in object space must equal the least distance to
/// any single ball. A bound that was found for one ball must not end the search in the next ball
/// too early.
TEST(Nearest, DistanceInObjectSpacesIsThatOfTheNearestObject) {
    test::RandomNumbers numbers(7);
    scene::Scene scene = test::make_lit_room(0, 1);
    for (int i = 0; i < 40; ++i)
        test::add_ball(scene, "ball", 0, 2.0 * dvec3(numbers.random_point_in_cube()), 1e-4, 2);
    const render::FrameGeometry geometry = render::make_geometry(
        scene, render::make_scene_units(scene), render::VertexSpaces::object_space);
    render::NearestTriangle nearest;
    nearest.set_geometry(geometry);
    std::size_t in_object_spaces = 0;
    for (int k = 0; k < 200; ++k) {
        const render::DrawRange& near =
            geometry.ranges[numbers.random_integer_below(geometry.ranges.size())];
        const dvec3 point = dvec3(near.bounds.centre()) +
                            .02 * dvec3(numbers.random_point_in_cube());
        float wanted = std::numeric_limits<float>::infinity();
        std::size_t which = 0;
        for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
            const float alone = nearest.distance(
                geometry, point,
                [&](std::size_t other, const render::DrawRange&) { return other != i; });
            if (alone < wanted) wanted = alone, which = i;
        }
        in_object_spaces += geometry.ranges[which].own.has_value();
        ASSERT_EQ(nearest.distance(geometry, point,
                                   [](std::size_t, const render::DrawRange&) { return false; }),
                  wanted);
    }
    EXPECT_GT(in_object_spaces, 100u);
}

TEST(Nearest, DistanceToAnEmptyGeometryIsInfinity) {
    const render::FrameGeometry geometry;
    render::NearestTriangle nearest;
    nearest.set_geometry(geometry);
    EXPECT_EQ(nearest.distance(geometry, dvec3(0),
                               [](std::size_t, const render::DrawRange&) { return false; }),
              std::numeric_limits<float>::infinity());
}

} // namespace
