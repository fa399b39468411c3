// Tests of render::find_backdrops, which finds the objects whose shadow falls on nothing
// for a given light.
#include "import/load.hpp"
#include "render/backdrop.hpp"
#include "render/space.hpp"
#include "scene/scene.hpp"
#include "scene/shapes.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using Names = std::vector<std::string>;

/// Returns the names of the objects that find_backdrops reports. The light is at `place`
/// in world units. A directional light instead shines along `place` from infinitely far away.
Names list_backdrop_names(const scene::Scene& scene, const dvec3& place, bool directional = false) {
    const render::SceneUnits space = render::make_scene_units(scene);
    shared::Light light{};
    light.kind = directional ? shared::kLightKindDirectional : shared::kLightKindPoint;
    light.position = vec3(space.to_scene(place));
    light.forward = vec3(place);
    const std::vector<std::uint8_t> found = render::find_backdrops(
        render::make_geometry(scene, space), light);
    Names names;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i]) names.push_back(scene.objects[i].name);
    return names;
}

/// Builds a room of 4 x 3 x 6 around the origin: six walls, named "0" to "5", and a crate.
scene::Scene make_backdrop_room() {
    scene::Scene scene{.name = "room"};
    const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)});
    for (int face = 0; face < 6; ++face) {
        test::add_mesh(scene, test::make_box_wall(face, {-2, -1.5, -3}, {2, 1.5, 3}), grey);
        scene.objects.back().name = std::to_string(face);
    }
    test::add_mesh(scene, scene::box("crate", {-.5, -1.5, -.5}, {.5, -.5, .5}), grey);
    scene.cameras = {{.eye = {0, 0, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 40}};
    return scene;
}

TEST(Backdrops, WallsOfTheRoomAroundTheLightAreBackdrops) {
    EXPECT_THAT(list_backdrop_names(make_backdrop_room(), {.3, 1.2, .4}),
                testing::ElementsAre("0", "1", "2", "3", "4", "5"));
}

TEST(Backdrops, WallBetweenLightAndRoomIsNoBackdrop) {
    EXPECT_EQ(list_backdrop_names(make_backdrop_room(), {5, 0, 0}).size(), 5u)
        << "all but the wall that it shines through";
    EXPECT_EQ(list_backdrop_names(make_backdrop_room(), {0, -1, 0}, true).size(), 5u)
        << "all but the ceiling";
}

TEST(Backdrops, WallWithGeometryBehindItIsNoBackdrop) {
    scene::Scene scene = make_backdrop_room();
    test::add_mesh(scene, scene::box("outside", {2.5, -1, -1}, {3, 1, 1}),
                   scene.objects[0].material);
    EXPECT_THAT(list_backdrop_names(scene, {0, 1, 0}),
                testing::ElementsAre("1", "2", "3", "4", "5"));
    // A shelf that begins inside the room and passes through the wall.
    scene = make_backdrop_room();
    test::add_quad(scene, "shelf", scene.objects[0].material, {1, 0, 0}, {3, 0, 0}, {3, 0, 1},
                   {1, 0, 1});
    EXPECT_THAT(list_backdrop_names(scene, {0, 1, 0}),
                testing::ElementsAre("1", "2", "3", "4", "5"));
    // A mirror that hangs .0001 in front of a wall casts its shadow on the wall.
    scene = make_backdrop_room();
    test::add_quad(scene, "mirror", scene.objects[0].material, {-1, -1, -2.9999}, {1, -1, -2.9999},
                   {1, 1, -2.9999}, {-1, 1, -2.9999});
    EXPECT_THAT(list_backdrop_names(scene, {0, 1, 0}), testing::Not(testing::Contains("mirror")));
}

/// The ground reaches to the horizon, and a shelf lies .001 above the ground. The shelf casts its
/// shadow on the ground.
TEST(Backdrops, ShelfCloseAboveAVastGroundIsNoBackdrop) {
    scene::Scene scene = make_backdrop_room();
    test::add_quad(scene, "ground", scene.objects[0].material, {-4e4, -1.5, 4e4}, {4e4, -1.5, 4e4},
                   {4e4, -1.5, -4e4}, {-4e4, -1.5, -4e4});
    test::add_quad(scene, "shelf", scene.objects[0].material, {-1, -1.499, 2}, {1, -1.499, 2},
                   {1, -1.499, 1}, {-1, -1.499, 1});
    const Names names = list_backdrop_names(scene, {0, 1, 0});
    EXPECT_THAT(names, testing::Contains("ground"));
    EXPECT_THAT(names, testing::Not(testing::Contains("shelf")));
}

/// The left wall of `cornell-mirrors` leans. The bounding boxes of the floor and the back wall
/// reach behind the plane of the left wall, but their vertices do not.
TEST(Backdrops, VerticesDecideWhereBoundingBoxesDoNot) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    EXPECT_THAT(list_backdrop_names(scene, {278, 548.7, 279.5}),
                testing::ElementsAre("floor", "ceiling", "back", "right", "left"));
}

TEST(Backdrops, LampsAndMeshesOfManyTrianglesAreNoBackdrops) {
    scene::Scene scene{.name = "dome"};
    const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)}),
                      glow = test::add_material(scene, {.name = "glow", .emission = vec3(1)});
    test::add_mesh(scene, test::make_box_wall(2, {-2, -1, -2}, {2, 1, 2}), glow);
    test::add_ball(scene, "dome", grey, {0, 0, 0}, 5, 4);
    scene.cameras = {{.eye = {0, 0, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 40}};
    EXPECT_THAT(list_backdrop_names(scene, {0, 0, 0}), testing::IsEmpty());
}

} // namespace
