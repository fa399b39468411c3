// Tests of the report's section on lag (how far a moving picture is behind its still picture), with
// made-up figures.
#include "measure/lag.hpp"
#include "report/comparison.hpp"
#include "report/plot.hpp"
#include "report_sample.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <regex>

namespace {

using catoptric::report::Comparison;
using catoptric::report::LagAtSpeed;
using catoptric::report::LagResults;
using catoptric::report::LagRow;
using catoptric::report::SettlingAfterCut;
using namespace catoptric::report::sample;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Returns lag figures for two instants. The first instant has no lag.
LagAtSpeed make_lag_at_speed(double speed, double flip) {
    return {speed,
            {make_difference_of_errors(0, 0), make_difference_of_errors(flip / 4, flip)},
            {make_difference_of_errors(.01, .1), make_difference_of_errors(.02, .1 + flip)}};
}

LagRow make_lag_row(const std::string& label) {
    LagRow row;
    row.label = label;
    row.still_frames = 5;
    row.still_reference_errors = {make_difference_of_errors(.01, .09),
                                  make_difference_of_errors(.02, .11)};
    row.after_black = {{0.2, 0.003, 0}, {0.9, 0.5, 0}, 2, 3};
    row.after_jump = {{0.001, 0, 0}, {0.9, 0.8, 0.7}, 1, {}};
    row.speeds = {make_lag_at_speed(1, 0.002), make_lag_at_speed(2, 0.004)};
    return row;
}

Comparison make_comparison_with_lag() {
    Comparison made = make_usual_comparison();
    made.lag = std::make_shared<LagResults>(
        LagResults{.seconds = {0, 2},
                   .path = 4,
                   .jump_from = 2,
                   .frame_cap = 3,
                   .rows = {make_lag_row("reuse"), make_lag_row("parallax")},
                   .without_history = {"naive", "raytrace:depth=16"}});
    return made;
}

TEST(LagReport, ReportWithoutLagMeasurementsHasNoLagSection) {
    EXPECT_THAT(report_text_of_comparison(make_usual_comparison()), Not(HasSubstr("Lag")));
    EXPECT_THAT(catoptric::report::to_html(make_usual_comparison()), Not(HasSubstr("Lag")));
    EXPECT_FALSE(json::parse(catoptric::report::to_json(make_usual_comparison())).contains("lag"));
}

TEST(LagReport, LagTableHasARowForEachSpeed) {
    const std::string text = report_text_of_comparison(make_comparison_with_lag());
    EXPECT_TRUE(std::regex_search(
        text,
        std::regex(
            R"(\| reuse +\| +2x \| +0\.0020 \| +0\.05 \| +0\.0003 \| +0\.0005 \| +0\.0020 \| +0\.0040 \| +2\.00 \| +0\.1020 \| +0\.1000 \|)")))
        << text;
    EXPECT_TRUE(std::regex_search(text, std::regex(R"(\| parallax +\| +1x \| +0\.0010 \|)")));
    EXPECT_THAT(text, HasSubstr("over a path of 4 s"));
    EXPECT_THAT(text, HasSubstr("of 2 instants"));
    EXPECT_THAT(text, Not(HasSubstr("still changed")));
}

TEST(LagReport, ReportSaysWhereTheFrameCapWasNotEnough) {
    Comparison made = make_comparison_with_lag();
    EXPECT_TRUE(std::regex_search(report_text_of_comparison(made),
                                  std::regex(R"(\| reuse +\| +2 \| +3 \| +1 \| +over 3 \|)")))
        << report_text_of_comparison(made);
    made.lag->rows[1].restless_stills = 2;
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("parallax: 2 stills still changed after 3 frames."));
}

TEST(LagReport, NoiseOfTheReferenceIsStated) {
    Comparison made = make_comparison_with_lag();
    const auto floor_in_json = [&] {
        return json::parse(catoptric::report::to_json(made))["lag"]["reference_flip_floor"];
    };
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("different random rays")));
    EXPECT_TRUE(floor_in_json().is_null());
    made.lag->reference_flip_floor = .0234;
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("with different random rays differ by a FLIP of 0.0234. Rows tie"));
    EXPECT_EQ(floor_in_json(), .0234);
}

TEST(LagReport, FewerRaysOfTheReferenceAreStated) {
    Comparison made = make_comparison_with_lag();
    made.lag->reference_rays = made.lag->wanted_reference_rays = 64;
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("--reference-seconds")));
    made.lag->reference_rays = 8;
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("The reference has 8 instead of 64 rays for each point of a rough "
                          "surface, which fit into --reference-seconds."));
    EXPECT_EQ(json::parse(catoptric::report::to_json(made))["lag"]["reference_rays"], 8);
}

TEST(LagReport, ReportDescribesLagInSentences) {
    Comparison made = make_comparison_with_lag();
    EXPECT_THAT(
        report_text_of_comparison(made),
        HasSubstr(
            "reuse is behind its own still picture by a FLIP of 0.0010 (median 0.0010, largest "
            "0.0020) at 1x, 0.0020 (median 0.0020, largest 0.0040) at 2x; after a cut from black "
            "it is within 1/255 "
            "from frame 2 by rmse, 3 in every pixel; after a jump of half the path from "
            "frame 1 by rmse, over 3 in every pixel."));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("have no lag: naive, raytrace:depth=16."));
    made.lag->rows.clear();
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("have no lag: naive, raytrace:depth=16."));
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("## Lag")));
}

TEST(LagReport, JsonContainsEveryLagFigure) {
    Comparison made = make_comparison_with_lag();
    made.lag->rows[0].speeds[0].errors[0] = {};
    const json lag = json::parse(catoptric::report::to_json(made))["lag"];
    EXPECT_EQ(lag["complete"], true);
    EXPECT_EQ(lag["seconds"], json({0, 2}));
    EXPECT_EQ(lag["path_seconds"], 4);
    EXPECT_EQ(lag["jump_from"], 2);
    EXPECT_EQ(lag["without_history"], json::array({"naive", "raytrace:depth=16"}));
    const json& row = lag["rows"][0];
    EXPECT_EQ(row["label"], "reuse");
    EXPECT_EQ(row["still_frames"], 5);
    EXPECT_EQ(row["after_black"]["rmse_settled"], 2);
    EXPECT_EQ(row["after_black"]["max"], json({0.9, 0.5, 0}));
    EXPECT_TRUE(row["after_jump"]["max_settled"].is_null());
    EXPECT_EQ(row["speeds"][1]["speed"], 2);
    const json& second = row["speeds"][1];
    for (const auto& [name, share] :
         {std::pair("flip", 1.0), {"off", .25}, {"mae", .125}, {"rmse", .25}}) {
        EXPECT_EQ(second[name], json({0, share * .004})) << name;
        EXPECT_DOUBLE_EQ(second[name + std::string("_mean")], share * .002) << name;
    }
    EXPECT_EQ(second["flip_median"], 0.002);
    EXPECT_EQ(second["flip_max"], 0.004);
    EXPECT_EQ(second["rmse_max"], 0.001);
    EXPECT_DOUBLE_EQ(second["reference_flip_mean"], 0.102);
    EXPECT_DOUBLE_EQ(second["reference_rmse_mean"], 0.015);
    EXPECT_DOUBLE_EQ(row["still_reference_flip_mean"], 0.1);
    EXPECT_DOUBLE_EQ(row["speeds"][0]["flip_mean"], 0.002) << "of the instant that is known";
    EXPECT_TRUE(row["speeds"][0]["flip"][0].is_null());
    EXPECT_TRUE(row["speeds"][0]["rmse"][0].is_null());
}

/// Counts the matches of the regular expression `pattern` in `text`.
std::ptrdiff_t count_pattern_matches(const std::string& text, const std::string& pattern) {
    const std::regex wanted(pattern);
    return std::distance(std::sregex_iterator(text.begin(), text.end(), wanted),
                         std::sregex_iterator());
}

TEST(LagReport, LagChartsHaveALineForEachSpeedAndEachRow) {
    Comparison made = make_comparison_with_lag();
    made.lag->rows[1].label = "<b>";
    const std::string html = catoptric::report::to_html(made);
    EXPECT_EQ(count_pattern_matches(html, R"(\{"name":"[^"]*","y":\[)"),
              2 * 2 + 2 + 2); // lines along the path, against speed, and after a jump
    int charts = 0;
    for (std::size_t at = 0; (at = html.find(R"({"kind":"lines")", at)) != html.npos; ++at) {
        const json chart = read_chart_data(html, html.rfind("<script", at));
        for (const json& line : chart["lines"])
            EXPECT_EQ(line["y"].size(), chart["x"].size()) << chart["says"] << line["name"];
        ++charts;
    }
    EXPECT_EQ(charts, 4) << "a path for each row, speeds, and a jump";
    EXPECT_THAT(html, Not(HasSubstr("<b>")));
    EXPECT_THAT(html, HasSubstr("<h2>Lag</h2>"));
    made.lag->rows.resize(1);
    made.lag->rows[0].speeds.clear(); // stopped before the first speed
    EXPECT_EQ(count_pattern_matches(catoptric::report::to_html(made), R"(\{"name":"[^"]*","y":\[)"),
              1);
}

} // namespace
