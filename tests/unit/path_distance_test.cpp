// Tests of the sentence on how far a reference is from path tracing, and of its place in reports.
#include "report/comparison.hpp"
#include "report/json.hpp"
#include "report/tables.hpp"
#include "report/writer.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using namespace catoptric;
using testing::HasSubstr;

measure::PathDistance make_distance(double flip, double noise) {
    measure::PathDistance distance;
    distance.flip = flip, distance.noise = noise;
    distance.flip_all = .5, distance.noise_all = .01;
    distance.width = 64, distance.height = 48, distance.paths = 40;
    distance.command = "catoptric compare room -o DIR --truth paths --techniques raytrace";
    return distance;
}

std::vector<report::Row> make_rows(const std::vector<double>& flips) {
    std::vector<report::Row> rows;
    for (const double flip : flips) {
        report::Row& row = rows.emplace_back();
        row.error.flip = row.error.rmse = flip;
    }
    return rows;
}

TEST(PathDistanceSentence, SaysTheIntervalAndHowManyRowsDifferLess) {
    EXPECT_EQ(report::describe_path_distance(make_distance(.75, .1), make_rows({.01, .6, .66})),
              "The reference itself, whose light is simplified, is FLIP 0.750 [0.650 - 0.850] from "
              "path tracing (over the mirrors, 64x48, 40 paths a pixel). 2 of 3 rows are closer to "
              "the reference than that. To judge rows by path tracing: catoptric compare room -o "
              "DIR --truth paths --techniques raytrace.");
    EXPECT_THAT(report::describe_path_distance(make_distance(.75, .1), make_rows({.01, .02})),
                HasSubstr(" All rows are closer to the reference than that."));
    EXPECT_THAT(report::describe_path_distance(make_distance(.75, .1), make_rows({.01, .7})),
                HasSubstr(" 1 of 2 rows is closer"));
    EXPECT_THAT(report::describe_path_distance(make_distance(.75, .1), {}),
                testing::Not(HasSubstr("closer")));
}

TEST(PathDistanceSentence, SaysABoundWhereTheNoiseIsLarger) {
    EXPECT_EQ(report::describe_path_distance(make_distance(.01, .012), make_rows({.01})),
              "The reference itself is at most FLIP 0.022 from path tracing (over the mirrors, "
              "64x48, 40 paths a pixel).");
}

TEST(PathDistanceSentence, TakesTheWholePictureWhereNoMirrorIsSeen) {
    EXPECT_THAT(report::describe_path_distance(make_distance(NAN, NAN), {}),
                HasSubstr("FLIP 0.500 [0.490 - 0.510] from path tracing (over the picture, which "
                          "shows no mirror, 64x48"));
}

TEST(PathDistanceSentence, SaysWhyTheDistanceIsNotKnownAndHowToFindOut) {
    measure::PathDistance distance = make_distance(NAN, NAN);
    distance.unknown = "a frame took 11 s, and 10 s are the limit";
    EXPECT_EQ(report::describe_path_distance(distance, {}),
              "How far the reference itself is from path tracing is not known: a frame took 11 s, "
              "and 10 s are the limit. To find out: catoptric compare room -o DIR --truth paths "
              "--techniques raytrace, with the same options for scene and camera.");
}

TEST(PathDistanceSentence, StandsInEveryReport) {
    report::Comparison comparison;
    comparison.rows = make_rows({.01});
    EXPECT_FALSE(report::report_json(comparison)["reference"].contains("path_distance"));
    EXPECT_THAT(report::to_markdown(comparison), testing::Not(HasSubstr("path tracing")));
    comparison.path_distance = std::make_shared<measure::PathDistance>(make_distance(.75, .1));
    EXPECT_THAT(report::to_markdown(comparison), HasSubstr("simplified, is FLIP 0.750"));
    EXPECT_THAT(report::to_html(comparison), HasSubstr("simplified, is FLIP 0.750"));
    const report::Json json = report::report_json(comparison)["reference"]["path_distance"];
    EXPECT_EQ(json["known"], true);
    EXPECT_EQ(json["flip"], .75);
    EXPECT_EQ(json["noise"], .1);
    EXPECT_EQ(json["interval"], report::Json::array({.65, .85}));
    EXPECT_EQ(json["size"], report::Json::array({64, 48}));
    EXPECT_EQ(json["paths"], 40);
    EXPECT_FALSE(json.contains("why"));
    comparison.path_distance->unknown = "no time";
    const report::Json unknown = report::report_json(comparison)["reference"]["path_distance"];
    EXPECT_EQ(unknown["known"], false);
    EXPECT_EQ(unknown["why"], "no time");
    EXPECT_TRUE(unknown["interval"].is_null());
    EXPECT_THAT(unknown["command"], HasSubstr("--truth paths"));
}

} // namespace
