// Tests of errors over several drawn views: medians, ties, and how reports show them.
#include "measure/views.hpp"

#include "report/tables.hpp"
#include "report/text.hpp"
#include "report_sample.hpp"
#include "study/views.hpp"
#include "support/refusal.hpp"
#include "support/scenes.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <memory>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <sstream>

namespace {

using namespace catoptric;
using namespace catoptric::report;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Returns a row whose FLIP over the mirrors in view i is `flips[i]`. NaN stands for a view without
/// mirror pixels.
Row make_row_with_view_flips(const std::string& label, const std::vector<double>& flips) {
    Row row = sample::make_row(label, 5, .1, .2);
    for (const double flip : flips) {
        measure::Errors errors;
        errors.error = sample::make_difference_of_errors(flip / 2, flip);
        if (std::isnan(flip)) errors.error = {};
        row.views.push_back(errors);
    }
    row.worst = std::make_shared<measure::WorstView>(measure::WorstView{2, measure::Picture(9, 3)});
    return row;
}

const std::vector<double> kFlipOfEachView{.1, .2, .3, .15, .25, .12, .22, .18};

std::vector<double> add_to_all_values(std::vector<double> values, double more) {
    for (double& value : values) value += more;
    return values;
}

Comparison make_comparison_with_views(std::vector<Row> rows) {
    Comparison made = sample::make_comparison(std::move(rows));
    for (std::uint64_t i = 0; i < kFlipOfEachView.size(); ++i)
        made.views.push_back({{"1,2," + std::to_string(i) + ":4,5,6:40",
                               {1, 2, double(i)},
                               {4, 5, 6},
                               {0, 1, 0},
                               40},
                              .5 * static_cast<double>(i),
                              100 + i});
    return made;
}

TEST(Views, EqualRowsTieOverViews) {
    const Row row = make_row_with_view_flips("a", kFlipOfEachView);
    for (const char* figure : {"flip", "off", "mae", "rmse"})
        EXPECT_FALSE(measure::rows_differ(row, row, figure)) << figure;
}

/// The two rows differ by 1e-6 in each view. The views differ from each other by far more.
TEST(Views, RowThatIsSlightlyWorseInEachViewDoesNotTie) {
    const Row a = make_row_with_view_flips("a", kFlipOfEachView),
              b = make_row_with_view_flips("b", add_to_all_values(kFlipOfEachView, 1e-6));
    EXPECT_TRUE(measure::rows_differ(a, b, "flip"));
    EXPECT_TRUE(measure::rows_differ(b, a, "flip"));
    EXPECT_LT(measure::metric_difference_interval(a, b, "flip").high, 0);
    EXPECT_GT(measure::metric_difference_interval(b, a, "flip").low, 0);
}

TEST(Views, OneOutlierDoesNotBreakATie) {
    std::vector<double> flips = kFlipOfEachView;
    flips[4] = .99;
    EXPECT_FALSE(measure::rows_differ(make_row_with_view_flips("a", kFlipOfEachView),
                                      make_row_with_view_flips("b", flips), "flip"));
    // With many views, one outlier does not hide a difference that all other views show.
    std::vector<double> many(30, .1), more(30, .11);
    more[7] = 0;
    EXPECT_TRUE(measure::rows_differ(make_row_with_view_flips("a", many),
                                     make_row_with_view_flips("b", more), "flip"));
}

TEST(Views, TooFewViewsAlwaysTie) {
    const std::vector<double> five(kFlipOfEachView.begin(), kFlipOfEachView.begin() + 5);
    EXPECT_FALSE(measure::rows_differ(make_row_with_view_flips("a", five),
                                      make_row_with_view_flips("b", add_to_all_values(five, .1)),
                                      "flip"));
    EXPECT_FALSE(measure::rows_differ(make_row_with_view_flips("a", kFlipOfEachView),
                                      make_row_with_view_flips("b", {}), "flip"))
        << "of a run cut short";
}

/// A view that shows no mirror pixel in one row is left out of the comparison of both rows.
TEST(Views, ViewsWithoutMirrorPixelsInOneRowAreLeftOutOfBoth) {
    std::vector<double> holed = add_to_all_values(kFlipOfEachView, 1e-3);
    holed[0] = test::kDoubleNan;
    EXPECT_TRUE(measure::rows_differ(make_row_with_view_flips("a", kFlipOfEachView),
                                     make_row_with_view_flips("b", holed), "flip"));
    holed[1] = holed[2] = test::kDoubleNan; // five views are left, too few
    EXPECT_FALSE(measure::rows_differ(make_row_with_view_flips("a", kFlipOfEachView),
                                      make_row_with_view_flips("b", holed), "flip"));
    const measure::Metric& flip = *std::ranges::find(measure::difference_metrics(), "flip",
                                                     &measure::Metric::name);
    const measure::MetricOverViews found = measure::metric_over_views(
        make_row_with_view_flips("b", holed), measure::row_masks().front(), flip);
    EXPECT_EQ(found.values.size(), 8u);
    EXPECT_NEAR(found.median, .181, 1e-12);
    EXPECT_FALSE(found.ci95.is_known());
}

TEST(Views, WithoutDrawnViewsAnyDifferenceCounts) {
    const Row a = sample::make_row("a", 5, .1, .2), b = sample::make_row("b", 5, .1, .2000001);
    EXPECT_TRUE(measure::rows_differ(a, b, "flip"));
    EXPECT_FALSE(measure::rows_differ(a, b, "rmse"));
    Row unknown = a;
    unknown.error = {};
    EXPECT_FALSE(measure::rows_differ(a, unknown, "flip"));
}

TEST(Views, MetricsThatAreNoNumberOfADifferenceAreRefused) {
    const Row row = make_row_with_view_flips("a", kFlipOfEachView);
    for (const char* name : {"max_at", "gpu_ms", "flop"})
        EXPECT_THAT(test::catch_error_text(Failure::internal,
                                           [&] { measure::rows_differ(row, row, name); }),
                    HasSubstr("'" + std::string(name) +
                              "': wanted a figure of a difference that is a number"));
}

TEST(Views, ReportHasASentenceAboutViewsForEachMetric) {
    Row exact = make_row_with_view_flips("exact", std::vector<double>(8, 0.0));
    exact.is_reference = true;
    std::vector<double> other = kFlipOfEachView; // larger than kFlipOfEachView in half of the views
    for (std::size_t i = 0; i < other.size(); ++i) other[i] += i % 2 == 0 ? -.01 : .01;
    const Comparison made = make_comparison_with_views(
        {make_row_with_view_flips("worst", add_to_all_values(kFlipOfEachView, .4)),
         make_row_with_view_flips("good", kFlipOfEachView), make_row_with_view_flips("fair", other),
         exact});
    const std::vector<std::string> words = describe_drawn_views(made);
    ASSERT_EQ(words.size(), 4u);
    EXPECT_EQ(words[0],
              "By FLIP, view by view, the least first: good, fair, worst. Ties: good and fair. All "
              "other pairs are apart.");
    EXPECT_THAT(words[1],
                testing::StartsWith("By off, view by view, the least first: good, fair, worst."));
    EXPECT_THAT(words[2], testing::StartsWith("By MAE, view by view, the least first: "));
    EXPECT_THAT(words[3], HasSubstr("95 % interval of their difference"));
    const auto first = [](const Comparison& of) { return describe_drawn_views(of).front(); };
    EXPECT_THAT(first(make_comparison_with_views({make_row_with_view_flips("a", kFlipOfEachView),
                                                  make_row_with_view_flips("b", kFlipOfEachView)})),
                HasSubstr("No two of them are apart."));
    EXPECT_THAT(first(make_comparison_with_views(
                    {make_row_with_view_flips("a", kFlipOfEachView),
                     make_row_with_view_flips("b", add_to_all_values(kFlipOfEachView, .1))})),
                HasSubstr("Every two of them are apart."));
}

/// A row with less error in nearly every view can still have the larger median.
TEST(Views, RowsAreOrderedByDifferencesNotByMedians) {
    const std::vector<double> low{.10, .11, .12, .13, .30, .31, .32, .33, .34};
    std::vector<double> less(low.size());
    for (std::size_t i = 0; i < low.size(); ++i) less[i] = low[i] - .001;
    less[0] = .99; // an outlier in one of nine views
    Comparison made = make_comparison_with_views(
        {make_row_with_view_flips("low", low), make_row_with_view_flips("less", less)});
    made.views.resize(low.size());
    const measure::RowOrder order = measure::order_rows(made).front();
    const measure::RowMask& mirrors = measure::row_masks().front();
    EXPECT_LT(measure::metric_over_views(made.rows[0], mirrors, *order.metric).median,
              measure::metric_over_views(made.rows[1], mirrors, *order.metric).median);
    EXPECT_EQ(order.rows, (std::vector<const Row*>{&made.rows[1], &made.rows[0]}));
    EXPECT_TRUE(order.ties.empty());
    EXPECT_TRUE(order.reversed.empty());
}

TEST(Views, ViewsTableHasMediansAndTheWorstView) {
    const ReportTable table = views_table(
        make_comparison_with_views({make_row_with_view_flips("a", kFlipOfEachView)}));
    EXPECT_EQ(table.title, "Over 8 views");
    std::map<std::string, std::string> cells;
    for (std::size_t i = 0; i < table.columns.size(); ++i)
        cells[table.columns[i].name] = table.rows.at(0).at(i);
    // With 8 views, the 95 % interval is the whole range.
    EXPECT_EQ(cells["FLIP"], "0.1900 [0.1000–0.3000]");
    EXPECT_EQ(cells["off, %"], "4.75 [2.50–7.50]");
    EXPECT_EQ(cells["MAE"], "0.0475 [0.0250–0.0750]");
    EXPECT_EQ(cells["Longest line"], "7 [4–11]");
    EXPECT_EQ(cells["Worst FLIP"], "0.3000");
    EXPECT_EQ(cells["Worst view"], "view 3 of 8: --camera 1,2,2:4,5,6:40 --time 1");
}

TEST(Views, JsonReportHoldsEachMetricOverEachMask) {
    const json document = json::parse(
        to_json(make_comparison_with_views({make_row_with_view_flips("a", kFlipOfEachView)})));
    ASSERT_EQ(document["views"].size(), 8u);
    EXPECT_EQ(document["views"][2]["camera"]["eye"], json({1, 2, 2}));
    EXPECT_EQ(document["views"][2]["time"], 1);
    EXPECT_EQ(document["views"][2]["seed"], 102);
    const json& views = document["rows"][0]["views"];
    const json& flip = views["error"]["flip"];
    EXPECT_NEAR(flip["median"].get<double>(), .19, 1e-12);
    EXPECT_EQ(flip["ci95"], json({.1, .3}));
    EXPECT_EQ(flip["values"], json(kFlipOfEachView));
    EXPECT_EQ(views["worst"],
              json::parse(R"({"view": 2, "flip": 0.3, "image": "images/worst-a.png"})"));
    for (const measure::RowMask& mask : measure::row_masks())
        for (const char* figure : {"flip", "off", "mae", "rmse", "longest_line", "psnr", "p99"})
            EXPECT_TRUE(views[std::string(mask.field)].contains(figure)) << mask.field << figure;
    EXPECT_TRUE(views["error_all"]["flip"]["median"].is_null()) << "nothing is known of it";
    EXPECT_TRUE(views["error_all"]["flip"]["ci95"].is_null());
    EXPECT_FALSE(views["error"].contains("max_at"));
}

TEST(Views, CsvReportHoldsTheMedianAndIntervalOverViews) {
    std::istringstream csv(
        to_csv(make_comparison_with_views({make_row_with_view_flips("a", kFlipOfEachView)})));
    std::string header, line;
    std::getline(csv, header), std::getline(csv, line);
    std::map<std::string, std::string> found;
    for (std::istringstream names(header), cells(line); names && cells;) {
        std::string name, cell;
        std::getline(names, name, ',');
        if (cells.peek() == '"') { // the text of a camera, in quotes
            cells.get();
            std::getline(cells, cell, '"');
            cells.get();
        } else {
            std::getline(cells, cell, ',');
        }
        found[name] = cell;
    }
    EXPECT_NEAR(std::stod(found["views_flip_median"]), .19, 1e-12);
    EXPECT_EQ(found["views_flip_low"], "0.1");
    EXPECT_EQ(found["views_flip_high"], "0.3");
    EXPECT_EQ(found["views_off_high"], "0.075");
    EXPECT_EQ(found["views"], "8");
    EXPECT_EQ(found["worst_view"], "2");
    EXPECT_EQ(found["worst_view_camera"], "1,2,2:4,5,6:40");
    EXPECT_EQ(found["worst_view_time"], "1");
}

TEST(Views, ReportsWithoutDrawnViewsDoNotMentionViews) {
    const Comparison made = sample::make_usual_comparison();
    EXPECT_EQ(json::parse(to_json(made))["views"], json::array());
    EXPECT_TRUE(json::parse(to_json(made))["rows"][0]["views"].is_null());
    for (const std::string& text : {to_csv(made), to_markdown(made), to_html(made)}) {
        EXPECT_THAT(text, Not(HasSubstr("views")));
        EXPECT_THAT(text, Not(HasSubstr("Worst")));
    }
}

TEST(Views, ReportSaysIfErrorsOverViewsAreIncomplete) {
    Comparison made = make_comparison_with_views({make_row_with_view_flips("a", kFlipOfEachView)});
    made.complete = false, made.asked = 1;
    EXPECT_THAT(to_markdown(made), Not(HasSubstr("errors over views")));
    made.rows[0].views.resize(7);
    EXPECT_THAT(to_markdown(made), HasSubstr("1 of 1 rows: the run had not ended when this was "
                                             "written; their errors over views were not measured "
                                             "to the end"));
}

session::Request make_request_of_scene(const scene::Scene& scene, std::uint64_t seed) {
    session::Request request;
    request.scene = scene;
    request.time = .5;
    request.seed = seed;
    return request;
}

std::vector<std::string> list_camera_texts(const std::vector<measure::View>& views) {
    std::vector<std::string> names;
    for (const measure::View& view : views) names.push_back(view.camera.name);
    return names;
}

TEST(DrawnViews, DrawnViewsAreDeterminedByTheirSeed) {
    const scene::Scene scene = test::make_lit_room(2, 1);
    const std::vector<measure::View> views = study::draw_views(make_request_of_scene(scene, 1), 12);
    ASSERT_EQ(views.size(), 12u);
    std::set<std::string> all;
    for (const measure::View& view : views) {
        all.insert(view.camera.name);
        EXPECT_EQ(view.time, .5) << "nothing moves";
    }
    EXPECT_EQ(list_camera_texts(study::draw_views(make_request_of_scene(scene, 1), 12)),
              list_camera_texts(views));
    // Neighbouring seeds share no view. If fewer views are drawn, they are the first ones of the
    // longer list.
    for (const std::string& name :
         list_camera_texts(study::draw_views(make_request_of_scene(scene, 2), 12)))
        all.insert(name);
    EXPECT_EQ(all.size(), 24u);
    EXPECT_EQ(study::draw_views(make_request_of_scene(scene, 1), 6).back().camera.name,
              views[5].camera.name);
}

TEST(DrawnViews, DrawnViewsAreAtInstantsOfOnePeriod) {
    scene::Scene scene = test::make_lit_room(2, 1);
    scene.objects.back().motion = scene::HarmonicMotion{.amplitude = {.1, 0, 0}, .period = 1.6};
    std::set<double> times;
    for (const measure::View& view : study::draw_views(make_request_of_scene(scene, 1), 12)) {
        EXPECT_GE(view.time, .5);
        EXPECT_LT(view.time, 2.1);
        EXPECT_EQ(view.time, std::round(view.time * 1000) / 1000) << "it can be typed";
        times.insert(view.time);
    }
    EXPECT_EQ(times.size(), 12u);
    EXPECT_LT(*times.begin(), .9);
    EXPECT_GT(*times.rbegin(), 1.7);
    const std::vector<measure::View> shared = study::draw_views(make_request_of_scene(scene, 1), 12,
                                                                4);
    std::set<std::string> cameras;
    for (std::size_t i = 0; i < shared.size(); ++i) {
        EXPECT_EQ(shared[i].time, shared[i / 4 * 4].time) << i;
        cameras.insert(shared[i].camera.name);
    }
    EXPECT_NE(shared[0].time, shared[4].time);
    EXPECT_EQ(cameras.size(), 12u);
}

TEST(DrawnViews, NumberOfDrawnViewsIsOneOrAtLeastSix) {
    const session::Request request = make_request_of_scene(test::make_lit_room(1, 1), 1);
    EXPECT_TRUE(study::draw_views(request, 1).empty());
    for (const int count : {-1, 0, 2, 5})
        EXPECT_THAT(
            test::catch_error_text(Failure::usage, [&] { study::draw_views(request, count); }),
            HasSubstr("views: wanted 1 or at least 6, because fewer give no 95 % interval of "
                      "the median, found " +
                      std::to_string(count)));
}

std::vector<measure::View> make_views_at_times(const std::vector<double>& times) {
    std::vector<measure::View> views;
    for (const double time : times) views.push_back({{}, time, 1});
    return views;
}

/// The expected values were computed by hand: mean squares 9 between and 1/2 within two instants.
TEST(SharedInstants, DesignEffectFollowsFromTheAnalysisOfVariance) {
    const std::vector<double> values{1, 2, 4, 5};
    const auto found = measure::estimate_shared_instants(make_views_at_times({0, 0, 1, 1}), values);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->instants, 2u);
    EXPECT_NEAR(found->design_effect, 1 + 8.5 / 9.5, 1e-12);
    EXPECT_NEAR(found->effective_views, 4 / (1 + 8.5 / 9.5), 1e-12);
}

TEST(SharedInstants, EqualViewsOfAnInstantCountAsOne) {
    const std::vector<double> values{.1, .1, .1, .5, .5, .5, .2, .2, .2};
    const auto found = measure::estimate_shared_instants(
        make_views_at_times({0, 0, 0, 1, 1, 1, 2, 2, 2}), values);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->design_effect, 3, 1e-12);
    EXPECT_NEAR(found->effective_views, 3, 1e-12);
}

/// Over many draws of the views, the variance of the mean must be that of the effective number of
/// independent views.
TEST(SharedInstants, VarianceOfTheMeanIsThatOfTheEffectiveViews) {
    constexpr int kDraws = 400, kInstants = 30, kCameras = 4;
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    std::vector<double> times;
    for (int i = 0; i < kInstants * kCameras; ++i) times.push_back(i / kCameras);
    const std::vector<measure::View> views = make_views_at_times(times);
    double squares = 0, effective = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
        std::vector<double> values;
        double sum = 0;
        for (int i = 0; i < kInstants; ++i) {
            const double of_instant = .7 * normal(random);
            for (int k = 0; k < kCameras; ++k) values.push_back(of_instant + normal(random));
        }
        for (const double value : values) sum += value / static_cast<double>(values.size());
        squares += sum * sum / kDraws;
        effective += measure::estimate_shared_instants(views, values)->effective_views / kDraws;
    }
    const double variance_of_view = 1 + .7 * .7;
    EXPECT_NEAR(variance_of_view / squares / effective, 1, .15);
}

TEST(SharedInstants, IndependentViewsHaveNoDesignEffect) {
    const std::vector<double> values{.1, .2, .3, .4};
    EXPECT_FALSE(measure::estimate_shared_instants(make_views_at_times({0, 1, 2, 3}), values))
        << "an instant each";
    EXPECT_FALSE(measure::estimate_shared_instants(make_views_at_times({2, 2, 2, 2}), values))
        << "a still scene";
    const std::vector<double> holed{.1, NAN, NAN, .4};
    EXPECT_FALSE(measure::estimate_shared_instants(make_views_at_times({0, 0, 1, 1}), holed))
        << "one view of each instant shows a mirror";
}

TEST(SharedInstants, TableAndJsonStateTheEffectiveNumberOfViews) {
    Comparison comparison = make_comparison_with_views(
        {make_row_with_view_flips("a", {.1, .1, .3, .3, .2, .2, .4, .4})});
    EXPECT_THAT(report::views_table(comparison).note, Not(HasSubstr("Effective views")));
    EXPECT_TRUE(json::parse(to_json(comparison))["rows"][0]["views"]["shared_instants"].is_null());
    for (std::size_t i = 0; i < comparison.views.size(); ++i)
        comparison.views[i].time = static_cast<double>(i / 2);
    const report::ReportTable table = report::views_table(comparison);
    EXPECT_THAT(table.note, HasSubstr("Effective views"));
    const auto column = std::ranges::find(table.columns, "Effective views",
                                          &report::TableColumn::name);
    ASSERT_NE(column, table.columns.end());
    EXPECT_EQ(table.rows[0][static_cast<std::size_t>(column - table.columns.begin())], "4");
    const json shared = json::parse(to_json(comparison))["rows"][0]["views"]["shared_instants"];
    EXPECT_EQ(shared["instants"], 4);
    EXPECT_EQ(shared["flip_design_effect"], 2);
    EXPECT_EQ(shared["effective_views"], 4);
}

} // namespace
