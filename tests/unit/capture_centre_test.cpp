// Tests of scene::capture_centre: a capture shows nothing if an object within the mirror
// encloses its centre.
#include "scene/build.hpp"
#include "scene/capture_centre.hpp"
#include "scene/shapes.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using namespace catoptric::scene;

/// Returns a mirror cube with its centre at (2, 0, 0) and edges of 2, and a second object.
Scene make_scene_with(Mesh second) {
    Scene scene{.name = "nested"};
    const std::size_t mirror = add_material(scene, {.name = "mirror", .mirror = true}),
                      stone = add_material(scene, {.name = "stone"});
    add_mesh(scene, box("outer", dvec3(-1), dvec3(1)), mirror);
    scene.objects.back().mirror = true;
    add_mesh(scene, std::move(second), stone);
    for (Object& object : scene.objects) object.world_from_object[3] = dvec4(2, 0, 0, 1);
    return scene;
}

TEST(CaptureCentre, IsThatOfTheBoundsUnlessSomethingWithinEnclosesIt) {
    Mesh open = box("open", dvec3(-.4), dvec3(.4));
    open.triangles.resize(4); // a shell with large holes
    for (const Mesh& mesh :
         {box("beside", dvec3(.1), dvec3(.5)), box("around", dvec3(-3), dvec3(3)), open})
        EXPECT_EQ(capture_centres(make_scene_with(mesh)), std::vector{dvec3(2, 0, 0)}) << mesh.name;
}

TEST(CaptureCentre, LeavesWhatEnclosesIt) {
    for (const double edge : {.1, .3, .5}) {
        const dvec3 centre = capture_centres(
            make_scene_with(box("core", dvec3(-edge), dvec3(edge))))[0];
        EXPECT_NEAR(centre.z, (edge + 1) / 2, .07) << "amid the core and the bounds";
        EXPECT_EQ(centre.x, 2);
    }
    // The post sticks out of the cube.
    const dvec3 beside = capture_centres(
        make_scene_with(box("post", dvec3(-.2, -.2, -1.5), dvec3(.2, .2, 1.5))))[0];
    EXPECT_NEAR(beside.x, 2.6, .05);
    EXPECT_EQ(beside.z, 0);
}

TEST(CaptureCentre, StaysIfEverythingIsEnclosed) {
    Scene scene = make_scene_with(box("core", dvec3(-.999), dvec3(.999)));
    EXPECT_EQ(capture_centres(scene)[0], dvec3(2, 0, 0));
}

} // namespace
