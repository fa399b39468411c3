// Whose shadow by a light falls on nothing.
#include "render/backdrop.hpp"
#include "render/space.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using Names = std::vector<std::string>;

/// By a light at a place in world units, or from infinitely far, along `place`.
Names backdrops(const scene::Scene& scene, const dvec3& place, bool directional = false) {
    const render::Space space = render::space_of(scene);
    shared::Light light{};
    light.kind = directional ? shared::kLightDirectional : shared::kLightAtPoint;
    light.position = vec3(space.place(place));
    light.forward = vec3(place);
    const std::vector<std::uint8_t> found = render::find_backdrops(
        render::make_geometry(scene, space), light);
    Names names;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i]) names.push_back(scene.objects[i].name);
    return names;
}

/// Six walls of a room of 4 x 3 x 6 around the origin, named by number, and a crate.
scene::Scene room() {
    scene::Scene scene{.name = "room"};
    const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)});
    for (int face = 0; face < 6; ++face) {
        test::add_mesh(scene, test::wall(face, {-2, -1.5, -3}, {2, 1.5, 3}), grey);
        scene.objects.back().name = std::to_string(face);
    }
    test::add_mesh(scene, scene::box("crate", {-.5, -1.5, -.5}, {.5, -.5, .5}), grey);
    scene.cameras = {{.eye = {0, 0, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 40}};
    return scene;
}

TEST(Backdrops, AreTheWallsOfARoomThatTheLightIsIn) {
    EXPECT_THAT(backdrops(room(), {.3, 1.2, .4}),
                testing::ElementsAre("0", "1", "2", "3", "4", "5"));
}

TEST(Backdrops, AreNotTheWallsBetweenALightAndTheRoom) {
    EXPECT_EQ(backdrops(room(), {5, 0, 0}).size(), 5u) << "all but the wall that it shines through";
    EXPECT_EQ(backdrops(room(), {0, -1, 0}, true).size(), 5u) << "all but the ceiling";
}

TEST(Backdrops, IsNoWallWithSomethingBehindIt) {
    scene::Scene scene = room();
    test::add_mesh(scene, scene::box("outside", {2.5, -1, -1}, {3, 1, 1}),
                   scene.objects[0].material);
    EXPECT_THAT(backdrops(scene, {0, 1, 0}), testing::ElementsAre("1", "2", "3", "4", "5"));
    // Through it, beginning inside.
    scene = room();
    test::add_quad(scene, "shelf", scene.objects[0].material, {1, 0, 0}, {3, 0, 0}, {3, 0, 1},
                   {1, 0, 1});
    EXPECT_THAT(backdrops(scene, {0, 1, 0}), testing::ElementsAre("1", "2", "3", "4", "5"));
    // By less than a sixteenth of a millimetre, too: a mirror that hangs before a wall.
    scene = room();
    test::add_quad(scene, "mirror", scene.objects[0].material, {-1, -1, -2.9999}, {1, -1, -2.9999},
                   {1, 1, -2.9999}, {-1, 1, -2.9999});
    EXPECT_THAT(backdrops(scene, {0, 1, 0}), testing::Not(testing::Contains("mirror")));
}

/// A shelf a millimetre before the ground, which reaches to the horizon.
TEST(Backdrops, AreToldBesideThingsThatReachFar) {
    scene::Scene scene = room();
    test::add_quad(scene, "ground", scene.objects[0].material, {-4e4, -1.5, 4e4}, {4e4, -1.5, 4e4},
                   {4e4, -1.5, -4e4}, {-4e4, -1.5, -4e4});
    test::add_quad(scene, "shelf", scene.objects[0].material, {-1, -1.499, 2}, {1, -1.499, 2},
                   {1, -1.499, 1}, {-1, -1.499, 1});
    const Names names = backdrops(scene, {0, 1, 0});
    EXPECT_THAT(names, testing::Contains("ground"));
    EXPECT_THAT(names, testing::Not(testing::Contains("shelf")));
}

/// The left wall leans: boxes of floor and back reach behind it, they do not.
TEST(Backdrops, AreToldByVerticesWhereBoxesDoNotTell) {
    const scene::Scene scene = scene::load("cornell-mirrors");
    EXPECT_THAT(backdrops(scene, {278, 548.7, 279.5}),
                testing::ElementsAre("floor", "ceiling", "back", "right", "left"));
}

TEST(Backdrops, AreNoLampsAndNothingOfManyTriangles) {
    scene::Scene scene{.name = "dome"};
    const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)}),
                      glow = test::add_material(scene, {.name = "glow", .emission = vec3(1)});
    test::add_mesh(scene, test::wall(2, {-2, -1, -2}, {2, 1, 2}), glow);
    test::add_ball(scene, "dome", grey, {0, 0, 0}, 5, 4);
    scene.cameras = {{.eye = {0, 0, 2}, .target = {0, 0, 0}, .vertical_fov_degrees = 40}};
    EXPECT_THAT(backdrops(scene, {0, 0, 0}), testing::IsEmpty());
}

} // namespace
