// Tests of the report of `catoptric stress`, which checks properties of the engine with extreme
// inputs.
#include "report/stress.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace {

using namespace catoptric::report;

StressRow make_stress_row(std::vector<StressCase> cases) {
    return {"N1", "a <stimulus>", "a property", StressVerdict::pass, "", std::move(cases), {}, 1};
}

TEST(StressRow, WorstCaseIsTheOneFurthestBeyondItsLimit) {
    EXPECT_EQ(
        make_stress_row({{"half", .5, 1}, {"all", 4, 4}, {"little", 9, 100}}).worst_case()->what,
        "all");
    EXPECT_EQ(make_stress_row({{"over nothing", 1e-9, 0}, {"ten times", 10, 1}}).worst_case()->what,
              "over nothing");
    EXPECT_EQ(make_stress_row({{"no number", std::nan(""), 1}, {"fine", 0, 0}}).worst_case()->what,
              "no number");
    EXPECT_EQ(make_stress_row({{"ugly", 100, 1, true}, {"wrong", 1.1, 1}, {"fine", 1, 1}})
                  .worst_case()
                  ->what,
              "wrong");
    EXPECT_EQ(make_stress_row({{"ugly", 2, 1, true}, {"fine", 1, 1}}).worst_case()->what, "ugly");
    EXPECT_EQ(make_stress_row({}).worst_case(), nullptr);
}

TEST(StressCase, StressCaseThatMeasuresNanFails) {
    EXPECT_FALSE((StressCase{"", std::nan(""), 1}).is_within_limit());
    EXPECT_TRUE((StressCase{"", 0, 0}).is_within_limit());
    EXPECT_FALSE((StressCase{"", 1e-300, 0}).is_within_limit());
}

TEST(Stress, StressFailsIfOneOfItsRowsFails) {
    StressResults stress;
    stress.rows = {make_stress_row({}), make_stress_row({})};
    EXPECT_FALSE(stress.has_failed_row());
    for (const StressVerdict verdict :
         {StressVerdict::quality_warning, StressVerdict::unsupported, StressVerdict::waived}) {
        stress.rows[1].verdict = verdict;
        EXPECT_FALSE(stress.has_failed_row()) << verdict_name(verdict);
    }
    stress.rows[1].verdict = StressVerdict::fail;
    EXPECT_TRUE(stress.has_failed_row());
}

/// A case that the device's limits do not allow has no figure and does not count as passed.
TEST(Stress, CaseThatCouldNotRunHasAReasonAndNoFigure) {
    StressResults stress;
    stress.rows = {make_stress_row({}), make_stress_row({{"the rest", .5, 1}})};
    stress.rows[0].verdict = StressVerdict::unsupported;
    stress.rows[0].remark = "the device allows max_memory = 5";
    stress.rows[1].not_run = {{"edge 16384", "allows max_size = 8192"}};
    EXPECT_THAT(stress.parts_not_run(),
                testing::ElementsAre("N1: the device allows max_memory = 5",
                                     "N1, edge 16384: allows max_size = 8192"));
    const nlohmann::json rows = nlohmann::json::parse(to_json(stress))["rows"];
    EXPECT_EQ(rows[0]["verdict"], "unsupported");
    EXPECT_TRUE(rows[0]["measured"].is_null() && rows[0]["threshold"].is_null());
    EXPECT_EQ(rows[0]["remark"], "the device allows max_memory = 5");
    EXPECT_TRUE(rows[0]["not_run"].empty());
    EXPECT_EQ(rows[1]["not_run"][0],
              (nlohmann::json{{"what", "edge 16384"}, {"why", "allows max_size = 8192"}}));
    for (const std::string& text : {to_html(stress), to_markdown(stress)}) {
        EXPECT_THAT(text, testing::HasSubstr("unsupported"));
        EXPECT_THAT(text, testing::HasSubstr("not run: edge 16384: allows max"));
    }
}

TEST(Stress, StressReportNamesTheMutationThatARowDetects) {
    StressResults stress;
    stress.rows = {make_stress_row({{"a", 0, 1}})};
    stress.rows[0].turned_red_by = "upside-down";
    EXPECT_EQ(nlohmann::json::parse(to_json(stress))["rows"][0]["turned_red_by"], "upside-down");
    EXPECT_THAT(to_html(stress), testing::HasSubstr("upside-down"));
    EXPECT_THAT(to_markdown(stress), testing::HasSubstr("upside-down"));
}

TEST(Stress, StressJsonHasEveryCaseAndHtmlEscapesTexts) {
    StressResults stress;
    stress.rows = {make_stress_row(
        {{"a", .25, .5}, {"b", std::nan(""), .5}, {"c", 1, .5, true, "odd <mirrors>"}})};
    const nlohmann::json report = nlohmann::json::parse(to_json(stress));
    EXPECT_EQ(report["rows"][0]["cases"][0], (nlohmann::json{{"what", "a"},
                                                             {"measured", .25},
                                                             {"threshold", .5},
                                                             {"holds", true},
                                                             {"quality", false},
                                                             {"seen", ""}}));
    EXPECT_TRUE(report["rows"][0]["measured"].is_null());
    EXPECT_EQ(report["rows"][0]["cases"][1]["holds"], false);
    EXPECT_EQ(report["rows"][0]["cases"][2]["quality"], true);
    EXPECT_EQ(report["rows"][0]["cases"][2]["seen"], "odd <mirrors>");
    EXPECT_THAT(to_html(stress), testing::HasSubstr("a &lt;stimulus&gt;"));
}

TEST(Stress, ResultSaysWhatAUserSeesOfAWarning) {
    StressResults stress;
    stress.rows = {make_stress_row({{"c", 1, .5, true, "odd <mirrors>"}, {"d", .1, .5}})};
    EXPECT_THAT(to_markdown(stress), testing::HasSubstr("c; odd"));
    stress.rows = {make_stress_row({{"c", .1, .5, true, "odd <mirrors>"}})};
    EXPECT_THAT(to_markdown(stress), testing::Not(testing::HasSubstr("odd")));
}

} // namespace
