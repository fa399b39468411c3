// Tests of the study that splits the distance of ray tracing to path tracing into causes.
#include "compare.hpp"
#include "measure/metric.hpp"
#include "report/comparison.hpp"
#include "report/writer.hpp"
#include "scene/classify.hpp"
#include "support/rendering.hpp"
#include "support/smooth_environment.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <iostream>
#include <map>

namespace {

using namespace catoptric;

/// Numbers of a cause by name.
using CauseNumbers = std::map<std::string, double>;

measure::Comparison compare_with_truth_causes(scene::Scene scene, int edge) {
    scene::find_mirrors(scene);
    study::CompareRequest request;
    request.base = test::make_test_request(scene, {"naive:face=16"}, {edge, edge});
    request.base.ambient = 0;
    request.reference_seconds = 0;
    request.studies = {{.name = "truth-causes"}};
    return study::compare(test::get_test_engine(), request);
}

std::vector<std::pair<std::string, CauseNumbers>>
list_truth_causes(const measure::Comparison& comparison) {
    const measure::MetricValue value = measure::study_metric(comparison.rows.front(),
                                                             "truth_causes");
    std::vector<std::pair<std::string, CauseNumbers>> causes;
    for (const measure::MetricParts& parts : std::get<std::vector<measure::MetricParts>>(value)) {
        causes.emplace_back(parts.name, CauseNumbers{});
        for (const auto& [name, number] : parts.values)
            causes.back().second[std::string(name)] = std::get<double>(number);
        std::cout << "[ MEASURED ] " << parts.name << ": share " << causes.back().second["share"]
                  << ", squared error " << causes.back().second["squared_error"] << " +- "
                  << causes.back().second["deviation"] << '\n';
    }
    return causes;
}

/// Expects that the first of `count` causes has the name, and removes the whole distance to path
/// tracing but for the share `tolerance`.
void expect_first_cause_is_the_only_one(const scene::Scene& scene, int edge, std::size_t count,
                                        const std::string& name, double tolerance) {
    const auto causes = list_truth_causes(compare_with_truth_causes(scene, edge));
    ASSERT_EQ(causes.size(), count);
    EXPECT_EQ(causes[0].first, name);
    EXPECT_GT(causes[0].second.at("squared_error"), 1e-4) << "little to see";
    EXPECT_NEAR(causes[0].second.at("share"), 1, tolerance);
}

/// Returns a white floor at y = 0, half of which is a mirror that faces up. No light goes from
/// floor or mirror to the floor.
scene::Scene make_floor_with_flat_mirror() {
    scene::Scene scene{.name = "half mirror"};
    const std::size_t white = test::add_material(scene, {.name = "white", .albedo = vec3(1)}),
                      mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_quad(scene, "floor", white, {-4, 0, 4}, {4, 0, 4}, {4, 0, 0}, {-4, 0, 0});
    test::add_quad(scene, "mirror", mirror, {-4, 0, 0}, {4, 0, 0}, {4, 0, -4}, {-4, 0, -4});
    scene.cameras.push_back({.name = "from above",
                             .eye = {0, .9, 0},
                             .target = {0, 0, 0},
                             .up = {0, 0, -1},
                             .vertical_fov_degrees = 60});
    return scene;
}

TEST(TruthCauses, PointLightAboveAFloorHasNoDistanceToPathTracing) {
    scene::Scene scene = make_floor_with_flat_mirror();
    scene.punctual.push_back({.intensity = vec3(2)});
    scene.punctual.back().world_from_light[3] = dvec4(.3, 2, .5, 1);
    const auto causes = list_truth_causes(compare_with_truth_causes(scene, 16));
    ASSERT_EQ(causes.size(), 1u) << "no lamp has an area, and there is no environment";
    EXPECT_EQ(causes[0].first, "light between surfaces");
    EXPECT_EQ(causes[0].second.at("share"), 0);
    EXPECT_LT(std::abs(causes[0].second.at("squared_error")), 1e-10) << "rounding of 64 rays";
    EXPECT_LT(causes[0].second.at("flip"), 1e-4);
}

TEST(TruthCauses, HalfHiddenSquareLampIsWrongAsAPointOnly) {
    scene::Scene scene = make_floor_with_flat_mirror();
    const std::size_t black = test::add_material(scene, {.name = "black", .albedo = vec3(0)}),
                      lamp = test::add_material(scene, {.name = "lamp", .emission = vec3(8)});
    test::add_quad(scene, "board", black, {0, 1, -9}, {9, 1, -9}, {9, 1, 9}, {0, 1, 9});
    test::add_quad(scene, "lamp", lamp, {-.5, 2, -.5}, {.5, 2, -.5}, {.5, 2, .5}, {-.5, 2, .5});
    const auto causes = list_truth_causes(compare_with_truth_causes(scene, 24));
    ASSERT_EQ(causes.size(), 2u);
    EXPECT_EQ(causes[0].first, "light as a point");
    EXPECT_NEAR(causes[0].second.at("share"), 1, .03);
    EXPECT_NEAR(causes[1].second.at("share"), 0, .03);
}

/// Half of the floor is seen through a tinted pane. The lamp is below the pane, so no light of the
/// lamp passes glass on its way to the floor.
TEST(TruthCauses, PaneOfGlassIsWrongAsADiffuseSurfaceOnly) {
    scene::Scene scene = make_floor_with_flat_mirror();
    const std::size_t pane = test::add_material(
        scene, {.name = "pane", .albedo = vec3(.5f), .roughness = 0, .transmission = 1});
    test::add_quad(scene, "pane", pane, {-.3, .4, .3}, {.3, .4, .3}, {.3, .4, .1}, {-.3, .4, .1});
    scene.punctual.push_back({.intensity = vec3(.1f)});
    scene.punctual.back().world_from_light[3] = dvec4(.3, .3, .5, 1);
    expect_first_cause_is_the_only_one(scene, 24, 2, "glass", .02);
}

/// Nothing hides the sky from a metal floor, and no light goes from the floor to itself.
TEST(TruthCauses, RoughMetalBelowASkyIsWrongAsASharpMirrorOnly) {
    scene::Scene scene{.name = "floor"};
    const std::size_t metal = test::add_material(
        scene, {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = .4f});
    test::add_quad(scene, "floor", metal, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}, {-50, 0, -50});
    scene.environment = test::make_smooth_environment();
    scene.cameras.push_back({.eye = {0, 3, 5}, .target = {0, 0, 0}, .vertical_fov_degrees = 30});
    expect_first_cause_is_the_only_one(scene, 16, 3, "rough lobes", .05);
}

TEST(TruthCauses, SharesAddUpAndStandInEveryReport) {
    scene::Scene scene = test::make_lit_room(1, 1);
    scene.environment = std::make_shared<scene::Environment>(
        scene::Environment{.name = "white", .size = {2, 1}, .texels = {vec3(.3f), vec3(.6f)}});
    const measure::Comparison found = compare_with_truth_causes(scene, 24);
    const auto causes = list_truth_causes(found);
    std::vector<std::string> names;
    double all = 0, mirrors = 0;
    for (const auto& [name, numbers] : causes) {
        names.push_back(name);
        all += numbers.at("share"), mirrors += numbers.at("mirrors_share");
    }
    EXPECT_THAT(names, testing::ElementsAre("light as a point", "occlusion of the environment",
                                            "light between surfaces"));
    EXPECT_NEAR(all, 1, 1e-12);
    EXPECT_NEAR(mirrors, 1, 1e-12);
    EXPECT_GT(causes.back().second.at("squared_error"), 0);
    EXPECT_EQ(causes.back().second.at("squared_error_left"), 0);
    for (std::size_t i = 1; i < causes.size(); ++i)
        EXPECT_EQ(causes[i].second.at("squared_error"),
                  causes[i - 1].second.at("squared_error_left"));
    EXPECT_THAT(report::to_json(found), testing::HasSubstr("\"truth_causes\""));
    EXPECT_THAT(report::to_markdown(found),
                testing::HasSubstr("Distance to path tracing by cause, mirrors"));
}

} // namespace
