// Tests that metrics, studies, scenes, kinds of light and techniques register themselves. Those of
// this file are in no central list, but must appear in every report and table.
#include "compare.hpp"
#include "core/error.hpp"
#include "import/load.hpp"
#include "measure/flip.hpp"
#include "measure/metric.hpp"
#include "measure/picture.hpp"
#include "reflect/technique.hpp"
#include "report/writer.hpp"
#include "report_sample.hpp"
#include "require/world_content_hashes.hpp"
#include "scene/built_in.hpp"
#include "scene/hash.hpp"
#include "scene/light_kind.hpp"
#include "session/scene_info.hpp"
#include "session/technique_choice.hpp"
#include "study/compare_checks.hpp"
#include "study/study.hpp"
#include "support/folder.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace {

using namespace catoptric;
using measure::MetricValue;
using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const measure::RegisteredMetric kRednessTestMetric{
    {.name = "test_only/redness",
     .unit = "parts",
     .help = "red of the first pixel",
     .better = measure::BetterDirection::more,
     .columns = {{"(test) redness", measure::ValueFormat::fixed, 2}},
     .get = [](const measure::Row& row) -> MetricValue {
         return row.hdr.pixels.empty() ? measure::Difference::kNone : row.hdr.pixels[0].x;
     }}};

const measure::RegisteredMetric kGreenerTestMetric{
    {.name = "test_only_greener",
     .help = "pixels of the mask in which a is greener than b",
     .columns = {{"(test) greener", measure::ValueFormat::fixed}},
     .get = [](const measure::PicturePair& compared) {
         double count = 0;
         for (std::size_t i = 0; i < compared.a.pixels.size(); ++i)
             count += (compared.mask.empty() || compared.mask[i] != 0) &&
                      compared.a.pixels[i].y > compared.b.pixels[i].y;
         return count;
     }}};

scene::Scene make_empty_scene() { return {.name = "test-only"}; }
const scene::RegisteredBuiltInScene kTestOnlyScene{
    {"test-only", "nothing at all", make_empty_scene}};

constexpr scene::PunctualLight::Kind kTestOnlyLightKind{200};
const scene::RegisteredLightKind kTestOnlyLightKindEntry{
    {.id = kTestOnlyLightKind,
     .name = "test-only",
     .gltf_type = "spot",
     .share = [](const scene::PointLight&, double cosine) { return cosine / 2; },
     .read = scene::read_spot_cone}};

constexpr std::string_view kReportTableRows[] = {"testonly", "testonly:much=2"};
constexpr Knob kTestOnlyKnobs[] = {
    {.name = "much", .help = "how much", .low = 1, .high = 3, .value = 1}};
constexpr reflect::Technique kTestOnlyTechnique{.name = "testonly",
                                                .summary = "For a test.",
                                                .order = 1000,
                                                .knobs = kTestOnlyKnobs,
                                                .compared = kReportTableRows,
                                                .search = "reflect/naive.frag"};
const reflect::RegisteredTechnique kTestOnlyTechniqueEntry{kTestOnlyTechnique};

const study::RegisteredStudy kTestOnlyStudy{
    {.name = "test-only",
     .help = "for a test",
     .number = "N",
     .low = 2,
     .high = 5,
     .check_reference =
         [](const std::string& reference) {
             check(reference == study::kReference, Failure::usage, "test-only: no reference");
         },
     .run =
         [](const study::StudyInput& input) {
             for (measure::Row& row : input.comparison.rows)
                 measure::set_study_metric(row, "test_only_half", input.count / 2.0);
         },
     .metrics = {{.name = "test_only_half",
                  .help = "half of the number",
                  .columns = {{"(test) half", measure::ValueFormat::fixed, 3}}}},
     .part = {.tables = [](const measure::Comparison& comparison) {
         report::ReportTable table{"(test) studied", {"(test) rows"}};
         if (std::ranges::count(comparison.studies, "test-only") > 0)
             table.rows = {{std::to_string(comparison.rows.size())}};
         return std::vector{table};
     }}}};

/// Returns a row whose picture has the same colour everywhere, with its difference from a black
/// picture.
measure::Row make_row_of_colour(const vec3& colour) {
    measure::Row row = report::sample::make_row("reuse", 7, .1, .2);
    std::ranges::fill(row.hdr.pixels, colour);
    const measure::Picture black(row.hdr.width, row.hdr.height);
    row.error = measure::difference(row.hdr, black, {}, row.flip_map);
    return row;
}

TEST(Tables, MetricsAndStudiesSayWhatTheyAre) {
    int units = 0;
    for (const measure::Metric& metric : measure::metrics()) {
        EXPECT_FALSE(metric.help.empty()) << metric.name;
        for (const std::string_view unit : {"ms", "bytes", "degrees"})
            if (metric.name.ends_with("_" + std::string(unit))) {
                EXPECT_EQ(metric.unit, unit) << metric.name;
                ++units;
            }
        for (const measure::MetricColumn& column : metric.columns)
            EXPECT_FALSE(column.title.empty()) << metric.name;
    }
    EXPECT_GT(units, 5);
    for (const study::Study& study : study::studies())
        EXPECT_FALSE(study.help.empty()) << study.name;
}

TEST(Tables, RegisteredMetricIsInEveryReportFile) {
    const measure::Comparison made = report::sample::make_comparison(
        {make_row_of_colour({.25F, .5F, 0})});
    const json row = json::parse(report::to_json(made))["rows"][0];
    EXPECT_EQ(row["test_only"]["redness"], .25);
    EXPECT_EQ(row["error"]["test_only_greener"], 12);
    EXPECT_TRUE(row["error_all"]["test_only_greener"].is_null()) << "nobody computed it there";
    const std::string csv = report::to_csv(made, report::CsvColumns::all);
    for (const char* name : {",test_only_redness,", ",mirrors_test_only_greener,",
                             ",first_order_test_only_greener,", ",mirror_1_test_only_greener,"})
        EXPECT_THAT(csv, HasSubstr(name));
    const std::string words = report::to_markdown(made), page = report::to_html(made);
    for (const std::string& text : {words, page}) {
        EXPECT_THAT(text, HasSubstr("(test) redness"));
        EXPECT_THAT(text, HasSubstr("(test) greener"));
        EXPECT_THAT(text, HasSubstr("0.25"));
    }
    EXPECT_THAT(page, HasSubstr("<td>12</td>"));
}

TEST(Tables, MetricsOfAStudyAreInReportsThatAskForIt) {
    measure::Comparison made = report::sample::make_comparison({make_row_of_colour({0, 0, 0})});
    for (const std::string& text : {report::to_json(made), report::to_markdown(made),
                                    report::to_html(made), report::to_csv(made)}) {
        EXPECT_THAT(text, Not(HasSubstr("test_only_half")));
        EXPECT_THAT(text, Not(HasSubstr("(test) half")));
        EXPECT_THAT(text, Not(HasSubstr("(test) studied")));
    }
    made.studies = {"test-only"};
    EXPECT_TRUE(json::parse(report::to_json(made))["rows"][0]["test_only_half"].is_null())
        << "the study has not run yet";
    measure::set_study_metric(made.rows[0], "test_only_half", 1.5);
    EXPECT_EQ(json::parse(report::to_json(made))["rows"][0]["test_only_half"], 1.5);
    EXPECT_THAT(report::to_csv(made), HasSubstr(",test_only_half,"));
    for (const std::string& text : {report::to_markdown(made), report::to_html(made)}) {
        EXPECT_THAT(text, HasSubstr("(test) half"));
        EXPECT_THAT(text, HasSubstr("1.500"));
        EXPECT_THAT(text, HasSubstr("(test) studied"));
    }
}

TEST(Tables, RegisteredStudyIsFoundAndAskedForItsReference) {
    std::vector<std::string_view> names;
    for (const study::Study& study : study::studies()) names.push_back(study.name);
    EXPECT_THAT(names, testing::ElementsAre("path-distance", "views", "causes", "lag", "row-times",
                                            "work", "costs", "map", "truth-causes", "test-only"));
    EXPECT_NO_THROW(study::check_study({"test-only", 2}, study::kReference));
    EXPECT_THROW(study::check_study({"test-only", 2}, "raytrace"), Error);
    try {
        study::check_study({"cause"}, study::kReference);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::usage);
        EXPECT_THAT(error.what(), HasSubstr("causes"));
    }
}

TEST(Tables, MetricOfADifferenceCountsOnlyItsMask) {
    const measure::Picture black(2, 1);
    measure::Picture green(2, 1);
    green.at(1, 0) = {0, 1, 0};
    const std::vector<float> map(2, 0.F);
    const auto greener = [&](const measure::Mask& mask) {
        const measure::Difference found = measure::difference(green, black, mask, map);
        const auto& table = measure::difference_metrics();
        const auto row = std::ranges::find(table, "test_only_greener", &measure::Metric::name);
        return std::get<double>(measure::metric_value(*row, found));
    };
    EXPECT_EQ(greener({}), 1);
    EXPECT_EQ(greener({255, 0}), 0);
    EXPECT_EQ(greener({0, 255}), 1);
}

TEST(Tables, MetricsAreSortedAndRefuseOtherSubjects) {
    const auto& table = measure::metrics();
    EXPECT_TRUE(std::ranges::is_sorted(table, {}, &measure::Metric::order));
    const auto find = [&](std::string_view name) {
        return *std::ranges::find(table, name, &measure::Metric::name);
    };
    EXPECT_EQ(find("gpu_ms").unit, "ms");
    EXPECT_EQ(find("psnr").better, measure::BetterDirection::more);
    const auto refused = [](const measure::Metric& metric, const auto& of) {
        try {
            measure::metric_value(metric, of);
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refused(find("rmse"), measure::Row()), HasSubstr("'rmse' is no figure of a row"));
    EXPECT_THAT(refused(find("gpu_ms"), measure::Difference()),
                HasSubstr("'gpu_ms' is no figure of a difference"));
}

TEST(Tables, RegisteredSceneIsFoundByName) {
    EXPECT_EQ(scene::load("test-only").name, "test-only");
    std::vector<std::string> names;
    for (const scene::BuiltInScene& scene : scene::built_in_scenes()) names.push_back(scene.name);
    EXPECT_EQ(names.front(), "cornell-mirrors");
    EXPECT_EQ(names.back(), "test-only");
    EXPECT_THAT(names, testing::IsSupersetOf(
                           {"cornell-mirrors-closed", "flat", "room", "gallery", "courtyard"}));
}

struct TableOfLightKinds : test::InFolder {};

TEST_F(TableOfLightKinds, RegisteredKindIsSavedLoadedHashedAndNamed) {
    scene::Scene scene = scene::make_cornell();
    scene.punctual.push_back({.name = "lamp",
                              .kind = kTestOnlyLightKind,
                              .intensity = vec3(1, 2, 3),
                              .cos_inner = std::cos(.2),
                              .cos_outer = std::cos(.4)});
    const std::filesystem::path file = folder / "lamp.glb";
    scene::save_glb(scene, file);
    const scene::Scene read = scene::load(file.string());
    ASSERT_EQ(read.punctual.size(), 1u);
    EXPECT_EQ(read.punctual[0].kind, kTestOnlyLightKind);
    EXPECT_NEAR(read.punctual[0].cos_outer, std::cos(.4), 1e-12);
    EXPECT_EQ(session::light_facts(read).back().kind, "test-only");
    EXPECT_FALSE(scene::list_lights(read).back().directional);
    EXPECT_EQ(scene::list_lights(read).back().cos_outer, read.punctual[0].cos_outer);

    scene::Scene spot = scene;
    spot.punctual[0].kind = scene::PunctualLight::Kind::spot;
    EXPECT_FALSE(scene::have_equal_emission(scene.punctual[0], spot.punctual[0]));
    EXPECT_NE(scene::hash_scene(scene), scene::hash_scene(spot));
    EXPECT_NE(require::hash_point_light(scene::list_lights(scene).back()),
              require::hash_point_light(scene::list_lights(spot).back()));
}

TEST_F(TableOfLightKinds, KindsHaveTheirOwnNumbers) {
    std::vector<std::string_view> names;
    for (const scene::LightKind& kind : scene::light_kinds()) names.push_back(kind.name);
    EXPECT_THAT(names, testing::ElementsAre("point", "spot", "directional", "test-only"));
    EXPECT_THROW(scene::find_light_kind(scene::PunctualLight::Kind{199}), Error);
}

TEST(Tables, RegisteredTechniqueIsFoundAndCompared) {
    EXPECT_EQ(session::parse_technique("testonly:much=3").settings[0].number, 3.0);
    EXPECT_EQ(session::techniques().back().name, "testonly");
    const std::vector<std::string> rows = study::default_techniques(
        {.scene = scene::make_cornell()});
    EXPECT_THAT(rows, Contains("testonly:much=2"));
    EXPECT_THAT(rows, Contains("naive:bounces=0"));
}

} // namespace
