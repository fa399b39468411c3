// Tests of measure::summarise_causes, which sums the causes of each pixel's error to the
// causes of a row's error.
#include "measure/causes.hpp"

#include "measure/light_edges.hpp"
#include "report/comparison.hpp"
#include "report/tables.hpp"
#include "report_sample.hpp"
#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

namespace {

using namespace catoptric;
using measure::Causes;
using measure::PixelCause;

constexpr std::uint32_t make_first_and_second_hit_word(std::uint32_t first, std::uint32_t second) {
    return first | second << 16;
}

// The hits of five pixels: a wall; mirror 1; mirror 2 that reflects mirror 1; mirror 3; mirror 3
// that reflects itself.
const std::array<std::uint32_t, 5> kSumUpHits{
    make_first_and_second_hit_word(0, 0), make_first_and_second_hit_word(1, 0),
    make_first_and_second_hit_word(2, 1), make_first_and_second_hit_word(3, 0),
    make_first_and_second_hit_word(3, 3)};
const std::vector<double> kFirstCauseWhole{.5, .25, 0, .25};
const std::vector<PixelCause> kTestErrorCauses{{"one", {.75, 0, .25, .125}, {.5, .25, 0, .25}},
                                               {"other", {-.25, .25, -.25, 0}, {0, 0, 0, -1}},
                                               {"rest", {0, 0, 0, .125}, {}}};
const measure::Mask kOffPixelMask{1, 1, 1, 0, 1};

TEST(SumUp, SharesOfClassesAndMirrorsAddUpToTheWhole) {
    const Causes causes = measure::summarise_causes(kSumUpHits, kOffPixelMask, kFirstCauseWhole,
                                                    kTestErrorCauses);
    EXPECT_EQ(causes.squared_error, .25);
    EXPECT_EQ(causes.squared_error_per_mirror, (std::vector{.5, .25, .125}));
    ASSERT_EQ(causes.list.size(), 3U);
    const measure::CauseShare& one = causes.list[0];
    EXPECT_EQ(one.name, "one");
    EXPECT_EQ(one.squared_error, 1.125 / 4);
    EXPECT_EQ(one.share, 1.125);
    EXPECT_EQ(one.share_first_order, 1.0);
    EXPECT_EQ(one.share_mirror_in_mirror, .125);
    EXPECT_EQ(one.share_per_mirror, (std::vector{.75, 0.0, .375}));
    EXPECT_EQ(one.alone, .25);
    EXPECT_EQ(one.alone_per_mirror, (std::vector{.5, .25, .125}));
    EXPECT_EQ(causes.list[1].share, -.25);
    EXPECT_EQ(causes.list[1].alone, -.25);
    EXPECT_EQ(causes.list[2].share, .125);
    EXPECT_TRUE(std::isnan(causes.list[2].alone)) << "the rest cannot be mended";
    EXPECT_EQ(causes.rest_rmse, std::sqrt(.125 / 4));
}

TEST(SumUp, LargestCauseIsNamedForPixelsThatAreOff) {
    // The pixels in order: no mirror; cause `one`; cause `other`; a pixel that is not off; cause
    // `one`, which is as large as `rest` but comes first.
    EXPECT_EQ(
        measure::summarise_causes(kSumUpHits, kOffPixelMask, kFirstCauseWhole, kTestErrorCauses)
            .largest,
        (std::vector<std::uint8_t>{0, 1, 2, 0, 1}));
}

TEST(SumUp, PixelsThatAreNotFiniteAreLeftOut) {
    std::vector<PixelCause> causes = kTestErrorCauses;
    causes[1].alone[0] = INFINITY;
    const Causes found = measure::summarise_causes(kSumUpHits, kOffPixelMask, kFirstCauseWhole,
                                                   causes);
    EXPECT_EQ(found.squared_error, .5 / 3);
    EXPECT_EQ(found.squared_error_per_mirror, (std::vector{0.0, .25, .125}));
    EXPECT_EQ(found.list[0].squared_error, .375 / 3);
    EXPECT_EQ(found.largest[1], 0);
}

TEST(SumUp, RowWithoutErrorHasNoShares) {
    const std::vector<double> none(4);
    const Causes found = measure::summarise_causes(kSumUpHits, measure::Mask(5), none,
                                                   {{"rest", none, {}}});
    EXPECT_EQ(found.squared_error, 0);
    EXPECT_TRUE(std::isnan(found.list[0].share));
    EXPECT_EQ(found.rest_rmse, 0);
    EXPECT_TRUE(measure::summarise_causes({}, {}, {}, {{"rest", {}, {}}}).list.empty());
}

TEST(SumUp, CausesWithAWrongNumberOfPixelsAreRefused) {
    for (const auto& [causes, words] :
         {std::pair(std::vector<PixelCause>{{"one", {1, 2}, {}}},
                    "one: wanted values of 4 mirror pixels, found 2"),
          {{{"one", {1, 2, 3, 4}, {1}}}, "one alone: wanted values of 4 mirror pixels, found 1"}})
        test::expect_error(
            [&] { measure::summarise_causes(kSumUpHits, kOffPixelMask, kFirstCauseWhole, causes); },
            Failure::internal, {words});
}

constexpr std::string_view kCausesOfLobes[] = {"noise", "filter", "distance law", "lobe shape"};

/// Returns one cause for each colour, or for each that perfect mirrors have. The first cause has
/// the whole error.
Causes make_causes_with_first_whole(bool is_rough = false) {
    Causes causes{.squared_error = .25, .squared_error_per_mirror = {.25}};
    for (const report::CauseColour& colour : report::cause_colours()) {
        const bool is_of_lobes = std::ranges::find(kCausesOfLobes, colour.cause) !=
                                 std::end(kCausesOfLobes);
        if (is_of_lobes && !is_rough) continue;
        const double share = causes.list.empty() ? 1 : 0;
        causes.list.push_back({.name = std::string(colour.cause),
                               .squared_error = share / 4,
                               .share = share,
                               .share_first_order = share / 4,
                               .share_mirror_in_mirror = share * 3 / 4,
                               .alone = colour.cause == "rest" ? NAN : .125});
    }
    causes.largest = {0, 1, 9, 3, 0, 0, 0, 0, 0, 0, 0, 0};
    return causes;
}

TEST(CauseTable, CauseTableHasSharesSumsAndBounds) {
    report::Row row = report::sample::make_row("parallax", 6, .5, .1);
    row.causes = std::make_shared<measure::Causes>(make_causes_with_first_whole());
    row.light_edges = std::make_shared<measure::LightEdgeErrors>();
    row.light_edges->share = .5;
    const report::ReportTable table = report::cause_table(
        report::sample::make_comparison({report::sample::make_row("raytrace", 6, 0, 0), row}));
    using Cells = std::vector<std::string>;
    ASSERT_EQ(table.columns.size(), 13U);
    EXPECT_EQ(table.columns[4].name, "direction (blue)");
    ASSERT_EQ(table.rows.size(), 4U);
    EXPECT_EQ(table.rows[0], (Cells{"parallax", "all", "100.0", "0.0", "0.0", "0.0", "0.0", "0.0",
                                    "0.0", "0.0", "0.0", "100.0", "50.0"}));
    EXPECT_EQ(table.rows[1], (Cells{"", "first order", "25.0", "0.0", "0.0", "0.0", "0.0", "0.0",
                                    "0.0", "0.0", "0.0", "25.0", ""}));
    EXPECT_EQ(table.rows[2], (Cells{"", "mirror in mirror", "75.0", "0.0", "0.0", "0.0", "0.0",
                                    "0.0", "0.0", "0.0", "0.0", "75.0", ""}));
    EXPECT_EQ(table.rows[3], (Cells{"", "bound", "50.0", "50.0", "50.0", "50.0", "50.0", "50.0",
                                    "50.0", "50.0", "–", "", ""}));
}

/// Causes of rough mirrors have columns if some row has them, and a dash in rows without them.
TEST(CauseTable, CausesOfRoughMirrorsHaveColumnsWhereTheyOccur) {
    report::Row sharp = report::sample::make_row("reuse", 6, .5, .1),
                rough = report::sample::make_row("parallax", 6, .5, .1);
    sharp.causes = std::make_shared<measure::Causes>(make_causes_with_first_whole());
    rough.causes = std::make_shared<measure::Causes>(make_causes_with_first_whole(true));
    const report::ReportTable perfect = report::cause_table(
                                  report::sample::make_comparison({sharp})),
                              both = report::cause_table(
                                  report::sample::make_comparison({sharp, rough}));
    EXPECT_EQ(perfect.note.find("On rough mirrors"), std::string::npos);
    EXPECT_NE(both.note.find("On rough mirrors, further causes"), std::string::npos);
    ASSERT_EQ(both.columns.size(), perfect.columns.size() + std::size(kCausesOfLobes));
    EXPECT_EQ(both.columns[4].name, "noise (violet)");
    EXPECT_EQ(both.columns[7].name, "lobe shape (crimson)");
    EXPECT_EQ(both.columns[8].name, "direction (blue)");
    ASSERT_EQ(both.rows.size(), 8U);
    for (const std::size_t column : {4, 5, 6, 7}) {
        EXPECT_EQ(both.rows[0][column], "–") << column;
        EXPECT_EQ(both.rows[4][column], "0.0") << column;
    }
    EXPECT_EQ(both.rows[0][15], "100.0");
    EXPECT_EQ(both.rows[4][15], "100.0");
}

TEST(CausePicture, CausePictureColoursEachPixelByItsLargestCause) {
    report::Row row = report::sample::make_row("parallax", 6, .5, .1);
    row.display.pixels[0] = vec3(1);
    row.causes = std::make_shared<measure::Causes>(make_causes_with_first_whole());
    const measure::Picture picture = report::cause_picture(row);
    EXPECT_EQ(picture.pixels[0], vec3(.35F)) << "dark";
    EXPECT_EQ(picture.pixels[1], vec3(86, 180, 233) / 255.0F);
    EXPECT_EQ(picture.pixels[2], vec3(190) / 255.0F);
    EXPECT_EQ(picture.pixels[3], vec3(0, 114, 178) / 255.0F);
    *row.causes = make_causes_with_first_whole(true);
    EXPECT_EQ(report::cause_picture(row).pixels[3], vec3(110, 60, 160) / 255.0F);
    row.causes->largest.pop_back();
    test::expect_error([&] { report::cause_picture(row); }, Failure::internal,
                       {"row 'parallax': wanted a cause for each of 12 pixels, found 11"});
    for (const report::CauseColour& a : report::cause_colours())
        for (const report::CauseColour& b : report::cause_colours())
            if (&a != &b) {
                EXPECT_GT(glm::distance(a.colour, b.colour), .25F) << a.name << ", " << b.name;
            }
}

} // namespace
