// Tests of the data of charts, which the page's script draws. tests/page/run.py tests the charts in
// a browser.
#include "measure/halves.hpp"
#include "report/chart.hpp"
#include "report_sample.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace {

using catoptric::report::Comparison;
using catoptric::report::rows_chart;
using namespace catoptric::report::sample;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

json find_chart_column(const json& data, const std::string& name) {
    for (const json& column : data["metrics"])
        if (column["name"] == name) return column;
    ADD_FAILURE() << "no column " << name << " in " << data["metrics"];
    return {};
}

TEST(Chart, RowsHaveTheirTimesMetricsAndIntervals) {
    Comparison made = make_usual_comparison();
    made.rows[1].gpu_ms = make_time_samples(7, .2);
    made.rows[3].gpu_ms.ci95 = {};
    const json data = read_chart_data(rows_chart(made));
    ASSERT_EQ(data["rows"].size(), made.rows.size());
    EXPECT_EQ(data["metrics"][0]["name"], "FLIP over the mirrors");
    for (std::size_t i = 0; i < made.rows.size(); ++i) {
        EXPECT_EQ(data["rows"][i]["label"], made.rows[i].label);
        EXPECT_EQ(data["rows"][i]["picture"], i + 1);
        EXPECT_EQ(data["rows"][i]["traced"], made.rows[i].technique == "raytrace");
        EXPECT_EQ(data["time"]["values"][i], made.rows[i].gpu_ms.median);
        EXPECT_EQ(data["metrics"][0]["values"][i], made.rows[i].error.flip);
        EXPECT_EQ(find_chart_column(data, "off, % over the mirrors")["values"][i],
                  100 * made.rows[i].error.off);
        EXPECT_EQ(find_chart_column(data, "MiB")["values"][i], 1);
    }
    EXPECT_NEAR(data["time"]["intervals"][1][0], 5.6, 1e-9);
    EXPECT_NEAR(data["time"]["intervals"][1][1], 8.4, 1e-9);
    EXPECT_TRUE(data["time"]["intervals"][3].is_null());
    EXPECT_FALSE(data.contains("floor"));
    json front = json::array();
    for (std::size_t i = 0; i < made.rows.size(); ++i)
        if (data["rows"][i]["front"]) front.push_back(i);
    EXPECT_EQ(front, json(made.pareto));
}

TEST(Chart, RowsWithoutATimeAreLeftOutAndMissingValuesAreNull) {
    Comparison made = make_usual_comparison();
    made.rows[0].gpu_ms.median = test::kDoubleNan;
    made.rows[2].error.flip = test::kDoubleNan;
    const json data = read_chart_data(rows_chart(made));
    ASSERT_EQ(data["rows"].size(), made.rows.size() - 1);
    EXPECT_EQ(data["rows"][0]["picture"], 2);
    EXPECT_TRUE(data["metrics"][0]["values"][1].is_null());
    for (catoptric::report::Row& row : made.rows) row.gpu_ms.median = 0;
    EXPECT_EQ(rows_chart(made), "");
    EXPECT_EQ(rows_chart(Comparison()), "");
}

TEST(Chart, ANoisyReferenceHasAFloorAndIntervalsOfRmse) {
    Comparison made = make_usual_comparison();
    made.noise = std::make_shared<catoptric::measure::ReferenceNoise>();
    made.noise->flip_floor = .03;
    catoptric::measure::NoiseFreeError estimate;
    estimate.squared_error = .0001;
    estimate.ci95 = {-.0001, .0004};
    catoptric::measure::set_noise(made.rows[1], {catoptric::measure::row_masks().size(), estimate});
    const json data = read_chart_data(rows_chart(made));
    EXPECT_EQ(data["floor"]["value"], .03);
    const json intervals = find_chart_column(data, "rmse over the mirrors")["intervals"];
    EXPECT_TRUE(intervals[0].is_null());
    EXPECT_NEAR(intervals[1][0], -.01, 1e-12);
    EXPECT_NEAR(intervals[1][1], .02, 1e-12);
}

TEST(Chart, LabelsCannotBecomeMarkup) {
    Comparison made = make_usual_comparison();
    made.rows[0].label = "</script><b>";
    const std::string html = rows_chart(made);
    EXPECT_THAT(html, Not(HasSubstr("</script><b>")));
    EXPECT_EQ(read_chart_data(html)["rows"][0]["label"], "</script><b>");
}

TEST(Chart, LinesHaveNullForMissingPoints) {
    catoptric::report::LineChart chart{
        .x_name = "x", .y_name = "y", .says = "both", .x = {0, 1, 2}};
    chart.lines = {{"a", {0, 0.5, 0}}, {"b", {test::kDoubleNan, 0.25, 1}}};
    const json data = read_chart_data(html_chart(chart));
    EXPECT_EQ(data["lines"], json::parse(R"([{"name": "a", "y": [0, 0.5, 0]},
                                             {"name": "b", "y": [null, 0.25, 1]}])"));
    chart.lines = {{"a", {test::kDoubleNan}}};
    EXPECT_EQ(html_chart(chart), "");
}

} // namespace
