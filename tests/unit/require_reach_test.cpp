// Tests of culled capture faces and culled shadow maps, and of the text about culled work.
#include "import/load.hpp"
#include "require/culled_work.hpp"
#include "require/reach.hpp"
#include "require/suggest.hpp"
#include "scene/built_in.hpp"
#include "scene/light.hpp"
#include "session/seeded_camera.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>

#include <array>

namespace {

using namespace catoptric;
using namespace catoptric::require;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(RequireFaces, FlatMirrorNeedsOnlyTheFacesInFront) {
    scene::Scene scene = scene::make_flat_room();
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    EXPECT_EQ(model.mirrors[0].faces, kAllFaces & ~(1 << 4)); // the mirror faces -z
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "face +Z of the capture of mirror 1 'mirror'");
    EXPECT_EQ(model.left_out[0].saves, "1 of six faces, each time that they would be drawn again");
}

TEST(RequireFaces, FlatMirrorSeenFromBothSidesNeedsAllFaces) {
    scene::Scene scene = scene::make_flat_room();
    // A ball behind the mirror's plane sees the mirror's back. The wall between them is moved away.
    const std::size_t mirror = scene.objects[6].material;
    scene.objects[4].world_from_object[3].z = 5;
    test::add_ball(scene, "ball", mirror, {1.7, 1, 4}, .2, 2);
    EXPECT_EQ(make_required_model({scene, scene.cameras[0]}).mirrors[0].faces, kAllFaces);
}

TEST(RequireFaces, PanelsOnOneWallNeedOnlyTheFacesInFront) {
    scene::Scene scene = scene::make_flat_room();
    const std::size_t mirror = scene.objects[6].material;
    test::add_quad(scene, "beside", mirror, {1.9, .5, 2.98}, {1.5, .5, 2.98}, {1.5, 2.1, 2.98},
                   {1.9, 2.1, 2.98});
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    EXPECT_EQ(model.mirrors[0].faces, kAllFaces & ~(1 << 4));
    EXPECT_EQ(model.mirrors[1].faces, kAllFaces & ~(1 << 4));
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "face +Z of the captures of mirrors 1-2");
}

TEST(RequireFaces, CurvedMirrorsAndOrthographicCamerasNeedAllFaces) {
    scene::Scene scene = scene::make_flat_room();
    scene.cameras[0].orthographic_height = 3;
    EXPECT_EQ(make_required_model({scene, scene.cameras[0]}).mirrors[0].faces, kAllFaces);
    EXPECT_EQ(find_flat_normal(scene::ball("", 2)), dvec3(0));
    EXPECT_EQ(find_flat_normal(scene::box("", dvec3(0), dvec3(1))), dvec3(0));
    EXPECT_EQ(find_flat_normal(scene.meshes[scene.objects[6].mesh]), dvec3(0, 0, -1));
}

TEST(RequireLights, LightThatReachesNothingVisibleNeedsNoShadowMap) {
    scene::Scene scene = test::make_lit_room(1, 1);
    const auto bare = [&](const char* name, dvec3 at, double range) {
        scene.punctual.push_back({.name = name, .intensity = vec3(4), .range = range});
        scene.punctual.back().world_from_light[3] = dvec4(at, 1);
    };
    bare("near", {0, 5, 0}, 2.9), bare("far", {0, 5, 0}, 3.1);
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    ASSERT_EQ(model.lights.size(), 3u);
    EXPECT_TRUE(model.lights[0].has_map);
    EXPECT_FALSE(model.lights[1].has_map); // the ceiling is 3 away, the range is 2.9
    EXPECT_TRUE(model.lights[2].has_map);
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "the shadow map of light 2 'near'");
    EXPECT_EQ(model.left_out[0].why,
              "nothing that is seen lies within its range and in front of it");
}

TEST(RequireLights, LightShiningAwayFromVisibleSurfacesNeedsNoShadowMap) {
    scene::Scene scene = test::make_lit_room(0, 0);
    const std::size_t lamp = add_material(scene, {.emission = vec3(9)});
    // Both lamps are above the ceiling. The first shines upwards, the second down at the ceiling's
    // back.
    test::add_quad(scene, "lamp", lamp, {0, 3, 0}, {0, 3, 1}, {1, 3, 1}, {1, 3, 0});
    test::add_quad(scene, "lamp", lamp, {0, 3, 0}, {1, 3, 0}, {1, 3, 1}, {0, 3, 1});
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    ASSERT_EQ(model.lights.size(), 2u);
    EXPECT_GT(scene::list_lights(scene)[0].normal.y, .9);
    EXPECT_FALSE(model.lights[0].has_map);
    EXPECT_TRUE(model.lights[1].has_map);
}

TEST(RequireLeftOut, CulledWorkOfManyMirrorsIsListedOnce) {
    EXPECT_EQ(format_ranges({1}), "1");
    EXPECT_EQ(format_ranges({1, 2, 3, 7, 9, 10}), "1-3, 7, 9-10");
    EXPECT_EQ(face_names(1 | 8 | 32), "+X -Y -Z");
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = add_material(scene, {.mirror = true});
    for (int i = 0; i < 50; ++i)
        test::add_ball(scene, "ball" + std::to_string(i), mirror, {.03 * i, 0, -5}, .2, 1);
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "the captures of mirrors 1-50");
    EXPECT_THAT(describe_model(model, scene), HasSubstr("  mirrors 1-50: not seen\n"));
    EXPECT_THAT(describe_model(model, scene), HasSubstr("    changes: no pixel\n"));
    const WorkModel all = make_everything_model({scene, scene.cameras[0]});
    EXPECT_THAT(describe_model(all, scene), HasSubstr("everything is required\n"));
    EXPECT_THAT(describe_model(all, scene), HasSubstr("nothing is left out\n"));
    EXPECT_THAT(describe_model(all, scene), Not(HasSubstr("kept")));
    EXPECT_THAT(describe_model(model, scene),
                HasSubstr("kept: 0 faces of captures, 1 shadow map\n"));
    const scene::Scene balls = scene::make_cornell();
    EXPECT_THAT(describe_model(make_required_model({balls, balls.cameras[0]}), balls),
                HasSubstr("kept: 24 faces of captures, 1 shadow map\n    why: "));
}

} // namespace
