// Tests of culled capture faces and culled shadow maps, of the text about culled work, and of
// suggested plans.
#include "require/culled_work.hpp"
#include "require/reach.hpp"
#include "require/suggest.hpp"
#include "scene/built_in.hpp"
#include "scene/light.hpp"
#include "scene/load.hpp"
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
    scene::Scene scene = scene::make_flat_mirror_room();
    const RequiredWorkModel model = make_required_model({scene, scene.cameras[0]});
    EXPECT_EQ(model.mirrors[0].faces, kAllCubeFaceBits & ~(1 << 4)); // the mirror faces -z
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "face +Z of the capture of mirror 1 'mirror'");
    EXPECT_EQ(model.left_out[0].saves, "1 of six faces, each time that they would be drawn again");
}

TEST(RequireFaces, FlatMirrorSeenFromBothSidesNeedsAllFaces) {
    scene::Scene scene = scene::make_flat_mirror_room();
    // A ball behind the mirror's plane sees the mirror's back. The wall between them is moved away.
    const std::size_t mirror = scene.objects[6].material;
    scene.objects[4].world_from_object[3].z = 5;
    test::add_ball(scene, "ball", mirror, {1.7, 1, 4}, .2, 2);
    EXPECT_EQ(make_required_model({scene, scene.cameras[0]}).mirrors[0].faces, kAllCubeFaceBits);
}

TEST(RequireFaces, PanelsOnOneWallNeedOnlyTheFacesInFront) {
    scene::Scene scene = scene::make_flat_mirror_room();
    const std::size_t mirror = scene.objects[6].material;
    test::add_quad(scene, "beside", mirror, {1.9, .5, 2.98}, {1.5, .5, 2.98}, {1.5, 2.1, 2.98},
                   {1.9, 2.1, 2.98});
    const RequiredWorkModel model = make_required_model({scene, scene.cameras[0]});
    EXPECT_EQ(model.mirrors[0].faces, kAllCubeFaceBits & ~(1 << 4));
    EXPECT_EQ(model.mirrors[1].faces, kAllCubeFaceBits & ~(1 << 4));
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "face +Z of the captures of mirrors 1-2");
}

TEST(RequireFaces, CurvedMirrorsAndOrthographicCamerasNeedAllFaces) {
    scene::Scene scene = scene::make_flat_mirror_room();
    scene.cameras[0].orthographic_height = 3;
    EXPECT_EQ(make_required_model({scene, scene.cameras[0]}).mirrors[0].faces, kAllCubeFaceBits);
    EXPECT_EQ(find_normal_of_flat_mesh(scene::ball("", 2)), dvec3(0));
    EXPECT_EQ(find_normal_of_flat_mesh(scene::box("", dvec3(0), dvec3(1))), dvec3(0));
    EXPECT_EQ(find_normal_of_flat_mesh(scene.meshes[scene.objects[6].mesh]), dvec3(0, 0, -1));
}

TEST(RequireLights, LightThatReachesNothingVisibleNeedsNoShadowMap) {
    scene::Scene scene = test::make_lit_room(1, 1);
    const auto bare = [&](const char* name, dvec3 at, double range) {
        scene.punctual.push_back({.name = name, .intensity = vec3(4), .range = range});
        scene.punctual.back().world_from_light[3] = dvec4(at, 1);
    };
    bare("near", {0, 5, 0}, 2.9), bare("far", {0, 5, 0}, 3.1);
    const RequiredWorkModel model = make_required_model({scene, scene.cameras[0]});
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
    const RequiredWorkModel model = make_required_model({scene, scene.cameras[0]});
    ASSERT_EQ(model.lights.size(), 2u);
    EXPECT_GT(scene::list_lights(scene)[0].normal.y, .9);
    EXPECT_FALSE(model.lights[0].has_map);
    EXPECT_TRUE(model.lights[1].has_map);
}

TEST(RequireLeftOut, CulledWorkOfManyMirrorsIsListedOnce) {
    EXPECT_EQ(format_number_ranges({1}), "1");
    EXPECT_EQ(format_number_ranges({1, 2, 3, 7, 9, 10}), "1-3, 7, 9-10");
    EXPECT_EQ(list_cube_face_names(1 | 8 | 32), "+X -Y -Z");
    scene::Scene scene = test::make_lit_room(0, 1);
    const std::size_t mirror = add_material(scene, {.mirror = true});
    for (int i = 0; i < 50; ++i)
        test::add_ball(scene, "ball" + std::to_string(i), mirror, {.03 * i, 0, -5}, .2, 1);
    const RequiredWorkModel model = make_required_model({scene, scene.cameras[0]});
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "the captures of mirrors 1-50");
    EXPECT_THAT(describe_model(model, scene), HasSubstr("  mirrors 1-50: not seen\n"));
    EXPECT_THAT(describe_model(model, scene), HasSubstr("    changes: no pixel\n"));
    const RequiredWorkModel all = make_everything_model({scene, scene.cameras[0]});
    EXPECT_THAT(describe_model(all, scene), HasSubstr("everything is required\n"));
    EXPECT_THAT(describe_model(all, scene), HasSubstr("nothing is left out\n"));
    EXPECT_THAT(describe_model(all, scene), Not(HasSubstr("kept")));
    EXPECT_THAT(describe_model(model, scene),
                HasSubstr("kept: 0 faces of captures, 1 shadow map\n"));
    const scene::Scene balls = scene::make_cornell_mirrors();
    EXPECT_THAT(describe_model(make_required_model({balls, balls.cameras[0]}), balls),
                HasSubstr("kept: 24 faces of captures, 1 shadow map\n    why: "));
}

TEST(RequireSuggest, EachBuiltInSceneGetsTheExpectedPlan) {
    const auto plan = [](const scene::Scene& rest) {
        const scene::Scene now = scene::scene_at_time(rest, 0);
        return suggest_technique_plan({now, now.cameras[0], {96, 96}}).plan;
    };
    EXPECT_EQ(plan(scene::make_cornell_mirrors()), "hybrid");
    EXPECT_EQ(plan(scene::make_closed_cornell_mirrors()), "4=march *=hybrid");
    EXPECT_EQ(plan(scene::make_flat_mirror_room()), "planar");
    EXPECT_EQ(plan(scene::make_furnished_room()), "planar");
    EXPECT_EQ(plan(scene::make_gallery()),
              "1,4=march 3,12,13,14,15=planar 10=reuse:face=64 *=hybrid");
    EXPECT_EQ(plan(scene::make_courtyard()), "hybrid");
    EXPECT_EQ(plan(scene::load("glass")), "raytrace") << "no other mirror is seen";
    scene::Scene glass = scene::load("glass");
    test::add_ball(glass, "ball", glass.objects.back().material - 1, {.1, .3, -1.2}, .3, 3);
    EXPECT_THAT(plan(glass), HasSubstr("hybrid"));
    scene::Scene turned = scene::load("glass");
    turned.cameras[0].target = turned.cameras[0].eye + dvec3(0, 0, -1);
    EXPECT_THAT(plan(turned), testing::Not(HasSubstr("raytrace"))) << "no glass is seen";
}

/// One mirror is behind a screen. Its bounds are in the camera's picture, but no pixel shows it.
TEST(RequireSuggest, PathsCountThePixelsThatShowAMirror) {
    scene::Scene scene = test::make_mirror_hall();
    const std::size_t mirror = scene.objects.back().material;
    const std::size_t grey = test::add_material(scene, {.name = "screen", .albedo = vec3(.5f)});
    test::add_quad(scene, "screen", grey, {-1.9, -1.9, -.9}, {-1.1, -1.9, -.9}, {-1.1, 1.9, -.9},
                   {-1.9, 1.9, -.9});
    test::add_quad(scene, "hidden", mirror, {-1.6, .5, -.5}, {-1.4, .5, -.5}, {-1.4, .7, -.5},
                   {-1.6, .7, -.5});
    scene.cameras[0].eye = {-1.5, .6, -2.9}, scene.cameras[0].target = {-.5, -.2, 0};
    const RequiredWorkModelInput question{scene, scene.cameras[0], {64, 64}};
    const MirrorPathCounts paths = trace_mirror_paths(question);
    EXPECT_EQ(paths.count, 64u * 64);
    EXPECT_GT(paths.first[2], 100u);
    EXPECT_EQ(paths.first[3], 0u);
    std::size_t on_mirrors = 0;
    for (const auto& [path, count] : paths.through)
        if (path.size() == 1) on_mirrors += count;
    EXPECT_EQ(on_mirrors, paths.count_paths_on_mirrors());
    const MirrorPathCounts open = trace_mirror_paths(
        {scene, test::make_mirror_hall().cameras[0], {64, 64}});
    EXPECT_GT(open.reached[0], open.first[0]) << "the ball is also seen in the others";
    EXPECT_GT(open.hidden[0], 0u) << "of what it shows its centre does not see all";
    EXPECT_LT(open.hidden[0], open.first[0] / 4);
}

/// A flat mirror reflects a mirror ball. If a box around the ball's centre encloses it, the ball's
/// capture shows nothing that the ball reflects. `planar` traces no rays in mirrored views, so it
/// would draw the ball wrongly.
TEST(RequireSuggest, PlanarIsNotSuggestedIfMirroredViewsShowWrongCaptures) {
    for (const bool is_walled_in : {false, true}) {
        scene::Scene scene = scene::make_flat_mirror_room();
        const std::size_t mirror = scene.objects[6].material;
        test::add_ball(scene, "ball", mirror, {.9, 1.1, -2}, .85, 3);
        if (is_walled_in)
            add_mesh(scene, scene::box("core", {.8, 1, -2.1}, {1, 1.2, -1.9}),
                     test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)}));
        const RequiredWorkModelInput question{scene, scene.cameras[0], {64, 64}};
        MirrorPathCounts paths = trace_mirror_paths(question);
        const std::size_t through = paths.through[{0, 1}], hidden = paths.hidden_after[{0, 1}];
        EXPECT_EQ(paths.first[1], 0u) << "the ball is seen in the flat mirror alone";
        EXPECT_GT(through, 60u);
        EXPECT_LE(hidden, is_walled_in ? through : through / 4);
        EXPECT_GE(hidden, is_walled_in ? through : 0);
        const PlanSuggestion suggestion = suggest_technique_plan(question);
        EXPECT_EQ(suggestion.candidates.front().techniques.front(),
                  is_walled_in ? "hybrid" : "planar");
    }
}

TEST(RequireSuggest, SuggestionGivesAReasonForEachMirror) {
    scene::Scene scene = test::make_mirror_hall();
    const std::size_t mirror = scene.objects.back().material;
    scene::Mesh bent = scene::quad("bent", {-1, -1, -1}, {-.4, -1, -1}, {-.4, -.4, -.999},
                                   {-1, -.4, -1});
    test::add_mesh(scene, bent, mirror);
    for (vec3& normal : scene.meshes.back().normals) normal = normalize(vec3(.005f, 0, -1));
    test::add_ball(scene, "outside", mirror, {0, 0, 9}, .5, 2);
    const PlanSuggestion suggestion = suggest_technique_plan({scene, scene.cameras[0], {96, 96}});
    EXPECT_THAT(suggestion.reasons,
                ElementsAre(HasSubstr(": a sphere, "), HasSubstr("planar: flat faces, "),
                            HasSubstr("planar: flat, "), HasSubstr("march: curved, "),
                            HasSubstr("reuse:face=64: a sphere, no pixel shows it")));
    EXPECT_EQ(suggestion.plan, "4=march 2,3=planar 5=reuse:face=64 *=hybrid");
    ASSERT_EQ(suggestion.candidates.size(), 2u);
    EXPECT_THAT(suggestion.candidates[0].name, HasSubstr("planar, "));
    EXPECT_LT(suggestion.candidates[0].error, suggestion.candidates[1].error);
    EXPECT_EQ(suggest_technique_plan({test::make_lit_room(0, 1), scene.cameras[0]}).plan, "hybrid");
}

TEST(RequireSuggest, UnseenMirrorCostsOneSmallCapture) {
    std::array<double, 2> costs{};
    for (const bool is_mirror : {false, true}) {
        scene::Scene scene = test::make_mirror_hall();
        const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)}),
                          material = is_mirror ? scene.objects.back().material : grey;
        test::add_ball(scene, "outside", material, {0, 0, 9}, .5, 2);
        const PlanSuggestion suggestion = suggest_technique_plan(
            {scene, scene.cameras[0], {96, 96}});
        ASSERT_EQ(suggestion.plan,
                  is_mirror ? "1=march 2,3=planar 4=reuse:face=64" : "1=march 2,3=planar");
        costs.at(is_mirror ? 1 : 0) = suggestion.candidates.front().cost;
        // The capture of the mirror draws all triangles once more.
        if (!is_mirror) costs[0] += static_cast<double>(scene::triangle_count(scene));
    }
    const PictureCostTable cost;
    EXPECT_NEAR(costs[1] - costs[0], cost.pass + cost.pixel * 6 * 64 * 64, 1e-6);
}

/// Tests drawn views of the four balls of the built-in scene. In some views, the capture of a ball
/// shows all that the ball reflects, in others nearly all or less.
TEST(RequireSuggest, HybridIsSuggestedOnlyIfItSavesATenthOfTheError) {
    const TechniqueErrorTable errors;
    const double most = .1 * errors.search / (errors.unknown - errors.search);
    bool is_traced = false, is_searched = false;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const scene::Scene scene = scene::scene_at_time(scene::make_cornell_mirrors(), 0);
        const scene::Camera camera = app::make_seeded_camera(scene, 0, seed);
        const RequiredWorkModelInput question{scene, camera, {96, 96}};
        const MirrorPathCounts paths = trace_mirror_paths(question);
        const PlanSuggestion suggestion = suggest_technique_plan(question);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::string& technique = suggestion.candidates.front().techniques[i];
            if (technique.starts_with("reuse")) continue;
            const bool traces = static_cast<double>(paths.hidden[i]) >
                                most * static_cast<double>(paths.first[i]);
            EXPECT_EQ(technique, traces ? "hybrid" : "march")
                << "camera " << seed << ", mirror " << i + 1;
            is_traced |= traces, is_searched |= !traces && paths.hidden[i] > 0;
        }
    }
    EXPECT_TRUE(is_traced);
    EXPECT_TRUE(is_searched) << "some mirror hides a little and is not traced";
}

/// If all visible mirrors are flat, `planar` draws them, and small captures suffice.
TEST(RequireSuggest, PlanarPlansUseSmallCaptures) {
    scene::Scene scene = test::make_mirror_hall();
    EXPECT_EQ(suggest_technique_plan({scene, scene.cameras[0], {96, 96}}).plan,
              "1=march 2,3=planar");
    scene.objects.erase(scene.objects.begin() +
                        static_cast<std::ptrdiff_t>(scene::mirrors(scene).front()));
    EXPECT_EQ(suggest_technique_plan({scene, scene.cameras[0], {96, 96}}).plan, "planar");
    test::add_ball(scene, "outside", scene.objects.back().material, {0, 0, 9}, .5, 2);
    EXPECT_EQ(suggest_technique_plan({scene, scene.cameras[0], {96, 96}}).plan,
              "1,2=planar:capture=64 3=reuse:face=64");
}

} // namespace
