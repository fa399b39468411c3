// Tests of the plans that `auto` chooses, and of the unit costs by which it compares them.
#include "require/suggest.hpp"

#include "import/load.hpp"
#include "places.hpp"
#include "require/plan_work.hpp"
#include "scene/built_in.hpp"
#include "scene/classify.hpp"
#include "session/seeded_camera.hpp"
#include "support/scenes.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <fstream>

namespace {

using namespace catoptric;
using namespace catoptric::require;
using testing::ElementsAre;
using testing::HasSubstr;

/// Returns the best candidate that rasterises mirrors.
const PlanCandidate& best_without_tracing(const PlanSuggestion& suggestion) {
    return *std::ranges::find_if(suggestion.candidates, [](const PlanCandidate& candidate) {
        return !candidate.name.starts_with("raytrace");
    });
}

/// Costs of a device that rasterises as the software driver does, and takes long for rays.
UnitCosts make_costs_with_dear_rays() {
    UnitCosts costs = default_unit_costs();
    for (const WorkKind kind : {WorkKind::camera_rays, WorkKind::mirror_rays}) costs.ns[kind] = 1e6;
    return costs;
}

TEST(RequireSuggest, EachBuiltInSceneGetsTheExpectedPlan) {
    const auto suggest = [](const scene::Scene& rest) {
        const scene::Scene now = scene::scene_at(rest, 0);
        return suggest_plan({now, now.cameras[0], {96, 96}});
    };
    const auto plan = [&](const scene::Scene& rest) {
        const PlanSuggestion suggestion = suggest(rest);
        EXPECT_THAT(suggestion.plan, testing::StartsWith("raytrace"))
            << "on the software driver, rays take a small picture less time than captures";
        return best_without_tracing(suggestion).plan;
    };
    EXPECT_EQ(plan(scene::make_cornell()), "hybrid");
    EXPECT_EQ(plan(scene::make_closed_cornell()), "4=march *=hybrid");
    EXPECT_EQ(plan(scene::make_flat_room()), "planar");
    EXPECT_EQ(plan(scene::make_furnished_room()), "planar");
    EXPECT_EQ(plan(scene::make_gallery()),
              "1,4=march 3,12,13,14,15=planar 10=reuse:face=64 *=hybrid");
    EXPECT_EQ(plan(scene::make_courtyard()), "hybrid");
    EXPECT_EQ(suggest(scene::load("glass")).plan, "raytrace") << "glass needs the usual depth";
    scene::Scene turned = scene::load("glass");
    turned.cameras[0].target = turned.cameras[0].eye + dvec3(0, 0, -1);
    EXPECT_THAT(suggest(turned).plan, testing::Not(HasSubstr("raytrace"))) << "no mirror is seen";
}

/// Tracing the whole picture is a candidate of every scene. The costs of the device decide.
TEST(RequireSuggest, CostsOfTheDeviceDecideBetweenRaysAndCaptures) {
    for (const char* name : {"flat", "room"}) {
        const scene::Scene now = scene::scene_at(scene::load(name), 0);
        const WorkModelInput input{now, now.cameras[0], {96, 96}};
        const PlanSuggestion cheap = suggest_plan(input),
                             dear = suggest_plan(input, make_costs_with_dear_rays());
        EXPECT_THAT(cheap.plan, testing::StartsWith("raytrace")) << name;
        EXPECT_THAT(dear.plan, testing::Not(HasSubstr("raytrace"))) << name;
        std::vector<std::string> names;
        for (const PlanCandidate& candidate : dear.candidates) names.push_back(candidate.name);
        EXPECT_THAT(names, testing::Contains(testing::StartsWith("raytrace"))) << name;
        EXPECT_THAT(names, testing::Contains(testing::EndsWith("first=raster"))) << name;
        EXPECT_TRUE(std::ranges::is_sorted(cheap.candidates, {}, &PlanCandidate::score));
    }
}

/// One ray for each pixel of a rough mirror is noise, so several are drawn from its lobe, and their
/// noise counts as error.
TEST(RequireSuggest, RoughMirrorsAreTracedByRaysOfTheirLobes) {
    scene::Scene scene = test::make_mirror_hall();
    scene::Material& material = scene.materials[scene.objects.back().material];
    material.mirror = false, material.metallic = 1, material.roughness = .3f;
    material.albedo = vec3(.9f);
    scene::find_mirrors(scene);
    const PlanSuggestion suggestion = suggest_plan({scene, scene.cameras[0], {96, 96}});
    const auto error_of = [&](const char* name) {
        const auto found = std::ranges::find(suggestion.candidates, name, &PlanCandidate::name);
        return found == suggestion.candidates.end() ? NAN : found->error;
    };
    const TechniqueErrors errors;
    EXPECT_NEAR(error_of("raytrace:depth=4,rays=1"), errors.one_rough_ray, 1e-9);
    EXPECT_NEAR(error_of("raytrace:depth=4,rays=4"), errors.four_rough_rays, 1e-9);
    EXPECT_GT(best_without_tracing(suggestion).error, errors.four_rough_rays);
}

/// The number of rays that auto predicts is the number that the ray tracer traces.
TEST(RequireSuggest, RaysOfAPictureAreCounted) {
    const scene::Scene scene = test::make_mirror_hall();
    const PathCounts paths = trace_paths({scene, scene.cameras[0], {64, 64}});
    EXPECT_EQ(paths.camera.rays, 64 * 64);
    double reflections = 0;
    for (const auto& [path, count] : paths.through)
        reflections += static_cast<double>(count); // paths through more mirrors count at each
    EXPECT_EQ(paths.sharp.rays, reflections) << "no other surface reflects";
    EXPECT_EQ(paths.rough.rays, 0);
    for (const WalkedRays& rays : {paths.camera, paths.sharp}) {
        EXPECT_GE(rays.nodes, rays.node_lanes) << "lanes of a group walk together";
        EXPECT_GE(rays.node_lanes * kLanesOfRays, rays.nodes);
    }
}

TEST(RequireUnitCosts, EachFileOfCostsIsKnown) {
    std::vector<std::string_view> names;
    for (const UnitCosts& costs : list_unit_costs()) names.push_back(costs.file);
    EXPECT_THAT(names,
                testing::IsSupersetOf({"h200", "llvmpipe-22.3", "llvmpipe-25.0", "rtx-2080-ti"}));
    for (const UnitCosts& costs : list_unit_costs()) {
        const auto document = nlohmann::json::parse(std::ifstream(
            test::source_folder() / "docs/costs" / (std::string(costs.file) + ".json")));
        EXPECT_EQ(document["device"], costs.device);
        for (const auto& unit : document["costs"]) {
            const auto kind = std::ranges::find(kWorkKinds, unit["work"].get<std::string>(),
                                                &WorkKindInfo::name);
            EXPECT_EQ(costs.ns.values.at(static_cast<std::size_t>(kind - std::begin(kWorkKinds))),
                      unit["ns"].get<double>());
        }
    }
}

TEST(RequireUnitCosts, DeviceWithoutAFileGetsTheMostSimilarCosts) {
    const auto file = [](const char* name, const char* driver, bool is_processor) {
        return find_unit_costs(name, driver, is_processor).costs.file;
    };
    EXPECT_EQ(file("NVIDIA H200", "NVIDIA 580.159.04", false), "h200");
    EXPECT_EQ(file("NVIDIA GeForce GTX 1080 Ti", "NVIDIA 550", false), "gtx-1080-ti");
    EXPECT_EQ(file("llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)", true),
              "llvmpipe-22.3");
    EXPECT_EQ(file("llvmpipe (LLVM 19.1.7, 128 bits)", "llvmpipe Mesa 25.2.1 (LLVM 19.1.7)", true),
              "llvmpipe-25.0");
    EXPECT_EQ(file("SwiftShader Device", "SwiftShader driver", true), "llvmpipe-22.3");
    EXPECT_EQ(file("AMD Radeon RX 7900", "radv", false), "rtx-2080-ti");
    EXPECT_THAT(find_unit_costs("NVIDIA H200", "NVIDIA 580.159.04", false).note,
                testing::StrEq("h200, fitted, for this device"));
    EXPECT_THAT(find_unit_costs("AMD Radeon RX 7900", "radv", false).note,
                testing::StrEq("rtx-2080-ti, literature, for GeForce RTX 2080 Ti, because "
                               "docs/costs has no file of AMD Radeon RX 7900"));
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
    const WorkModelInput input{scene, scene.cameras[0], {64, 64}};
    const PathCounts paths = trace_paths(input);
    EXPECT_EQ(paths.count, 64u * 64);
    EXPECT_GT(paths.first[2], 100u);
    EXPECT_EQ(paths.first[3], 0u);
    std::size_t on_mirrors = 0;
    for (const auto& [path, count] : paths.through)
        if (path.size() == 1) on_mirrors += count;
    EXPECT_EQ(on_mirrors, paths.on_mirrors());
    const PathCounts open = trace_paths({scene, test::make_mirror_hall().cameras[0], {64, 64}});
    EXPECT_GT(open.reached[0], open.first[0]) << "the ball is also seen in the others";
    EXPECT_GT(open.hidden[0], 0u) << "of what it shows its centre does not see all";
    EXPECT_LT(open.hidden[0], open.first[0] / 4);
}

/// A flat mirror reflects a mirror ball. If six walls around the ball's centre enclose it, the
/// ball's capture shows nothing that the ball reflects. (The centre of a capture leaves one closed
/// object: scene/capture_centre.hpp.) `planar` traces no rays in mirrored views, so it
/// would draw the ball wrongly.
TEST(RequireSuggest, PlanarIsNotSuggestedIfMirroredViewsShowWrongCaptures) {
    for (const bool is_walled_in : {false, true}) {
        scene::Scene scene = scene::make_flat_room();
        const std::size_t mirror = scene.objects[6].material;
        test::add_ball(scene, "ball", mirror, {.9, 1.1, -2}, .85, 3);
        if (is_walled_in)
            for (int face = 0; face < 6; ++face)
                add_mesh(scene, test::make_box_wall(face, {.8, 1, -2.1}, {1, 1.2, -1.9}),
                         test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)}));
        const WorkModelInput input{scene, scene.cameras[0], {64, 64}};
        PathCounts paths = trace_paths(input);
        const std::size_t through = paths.through[{0, 1}], hidden = paths.hidden_after[{0, 1}];
        EXPECT_EQ(paths.first[1], 0u) << "the ball is seen in the flat mirror alone";
        EXPECT_GT(through, 60u);
        EXPECT_LE(hidden, is_walled_in ? through : through / 4);
        EXPECT_GE(hidden, is_walled_in ? through : 0);
        const PlanSuggestion suggestion = suggest_plan(input);
        EXPECT_EQ(best_without_tracing(suggestion).techniques.front(),
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
    const PlanSuggestion suggestion = suggest_plan({scene, scene.cameras[0], {96, 96}},
                                                   make_costs_with_dear_rays());
    EXPECT_THAT(suggestion.reasons,
                ElementsAre(HasSubstr(": a sphere, "), HasSubstr("planar: flat faces, "),
                            HasSubstr("planar: flat, "), HasSubstr("march: curved, "),
                            HasSubstr("reuse:face=64: a sphere, no pixel shows it")));
    EXPECT_EQ(suggestion.plan, "4=march 2,3=planar 5=reuse:face=64 *=hybrid");
    ASSERT_EQ(suggestion.candidates.size(), 4u);
    EXPECT_THAT(suggestion.candidates[0].name, HasSubstr("planar, "));
    EXPECT_LT(suggestion.candidates[0].error, suggestion.candidates[1].error);
    EXPECT_THAT(format_candidates(suggestion.candidates, "h200, fitted, for this device"),
                testing::AllOf(HasSubstr(" (chosen)\n"),
                               HasSubstr("  raytrace:first=raster: predicted "),
                               HasSubstr("  why: least score, which is the time times (1 + FLIP / "
                                         "0.005); unit costs: h200, fitted, for this device\n")));
    EXPECT_EQ(suggest_plan({test::make_lit_room(0, 1), scene.cameras[0]}).plan, "hybrid");
}

TEST(RequireSuggest, UnseenMirrorCostsOneSmallCapture) {
    std::array<double, 2> costs{};
    double capture = 0;
    for (const bool is_mirror : {false, true}) {
        scene::Scene scene = test::make_mirror_hall();
        const std::size_t grey = test::add_material(scene, {.name = "grey", .albedo = vec3(.5f)}),
                          material = is_mirror ? scene.objects.back().material : grey;
        test::add_ball(scene, "outside", material, {0, 0, 9}, .5, 2);
        const WorkModelInput input{scene, scene.cameras[0], {96, 96}};
        const PlanSuggestion suggestion = suggest_plan(input);
        const PlanCandidate& best = best_without_tracing(suggestion);
        ASSERT_EQ(best.plan,
                  is_mirror ? "1=march 2,3=planar 4=reuse:face=64" : "1=march 2,3=planar");
        costs.at(is_mirror ? 1 : 0) = best.ms;
        const PictureCounts picture = count_picture(input, trace_paths(input));
        FrameWork with(picture);
        with.add_capture(64, false, false);
        capture = predict_ms(with.work(), default_unit_costs()) -
                  predict_ms(FrameWork(picture).work(), default_unit_costs());
    }
    EXPECT_NEAR(costs[1] - costs[0], capture, 1e-9);
}

/// Tests drawn views of the four balls of the built-in scene. In some views, the capture of a ball
/// shows all that the ball reflects, in others nearly all or less.
TEST(RequireSuggest, HybridIsSuggestedOnlyIfItSavesATenthOfTheError) {
    const TechniqueErrors errors;
    const double most = .1 * errors.search / (errors.unknown - errors.search);
    bool is_traced = false, is_searched = false;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const scene::Scene scene = scene::scene_at(scene::make_cornell(), 0);
        const scene::Camera camera = session::make_seeded_camera(scene, 0, seed);
        const WorkModelInput input{scene, camera, {96, 96}};
        const PathCounts paths = trace_paths(input);
        const PlanSuggestion suggestion = suggest_plan(input);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::string& technique = best_without_tracing(suggestion).techniques[i];
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
    const auto plan = [&] {
        return best_without_tracing(suggest_plan({scene, scene.cameras[0], {96, 96}})).plan;
    };
    EXPECT_EQ(plan(), "1=march 2,3=planar");
    scene.objects.erase(scene.objects.begin() +
                        static_cast<std::ptrdiff_t>(scene::mirrors(scene).front()));
    EXPECT_EQ(plan(), "planar");
    test::add_ball(scene, "outside", scene.objects.back().material, {0, 0, 9}, .5, 2);
    EXPECT_EQ(plan(), "1,2=planar:capture=64 3=reuse:face=64");
}

} // namespace
