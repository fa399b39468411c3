// Tests of figures for papers, and of the bars of times by pass.
#include "core/file.hpp"
#include "measure/causes.hpp"
#include "report/figures.hpp"
#include "report/pass_times.hpp"
#include "report/tables.hpp"
#include "report_sample.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <memory>
#include <regex>

namespace {

namespace fs = std::filesystem;

using namespace catoptric;
using namespace catoptric::report;
using namespace catoptric::report::sample;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Returns the widths of the filled rectangles of a drawing that have a title, in their order.
std::vector<double> list_bar_widths(const std::string& svg) {
    static const std::regex pattern(R"re(width="([0-9.]+)" height="14"[^>]*><title>)re");
    std::vector<double> widths;
    for (std::sregex_iterator found(svg.begin(), svg.end(), pattern), end; found != end; ++found)
        widths.push_back(std::stod((*found)[1]));
    return widths;
}

TEST(StackedBarsDrawing, WidthsAreInProportionToTheLengths) {
    const StackedBars chart{.x_name = "ms",
                            .says = "a <drawing>",
                            .kinds = {{"view", "#000"}, {"trace", "#111"}, {"unused", "#222"}},
                            .bars = {{"long", {30, 10, 0}}, {"short & thin", {NAN, 20}}}};
    const std::string svg = draw_bars(chart);
    const std::vector<double> widths = list_bar_widths(svg);
    ASSERT_EQ(widths.size(), 3U);
    EXPECT_NEAR(widths[0], 3 * widths[1], .02);
    EXPECT_NEAR(widths[2], 2 * widths[1], .02);
    EXPECT_THAT(svg, HasSubstr("short &amp; thin"));
    EXPECT_THAT(svg, HasSubstr("a &lt;drawing&gt;"));
    EXPECT_THAT(svg, HasSubstr(">40</text>")); // the last tick
    EXPECT_THAT(svg, HasSubstr(">trace</text>"));
    EXPECT_THAT(svg, Not(HasSubstr(">unused</text>")));
    EXPECT_EQ(draw_bars({.kinds = {{"view", "#000"}}, .bars = {{"none", {0}}}}), "");
}

TEST(StackedBarsDrawing, NumbersOfTheAxisAreBetweenTheBarsAndTheNameOfTheAxis) {
    const std::string svg = draw_bars(
        {.x_name = "ms", .kinds = {{"view", "#000"}}, .bars = {{"one", {30}}, {"two", {20}}}});
    const auto list_heights = [&](const std::string& pattern) {
        std::vector<double> heights;
        const std::regex compiled(pattern);
        for (std::sregex_iterator found(svg.begin(), svg.end(), compiled), end; found != end;
             ++found)
            heights.push_back(std::stod((*found)[1]));
        return heights;
    };
    const std::vector<double> bars = list_heights(R"re(<rect [^>]*y="([0-9.]+)"[^>]*><title>)re");
    const std::vector<double> numbers = list_heights(R"re(y="([0-9.]+)"[^>]*>[0-9]+</text>)re");
    const std::vector<double> name = list_heights(R"re(y="([0-9.]+)"[^>]*>ms</text>)re");
    ASSERT_EQ(bars.size(), 2U);
    ASSERT_GE(numbers.size(), 3U);
    ASSERT_EQ(name.size(), 1U);
    // The position of a text is its base line. Letters are about ten units high.
    for (const double number : numbers) {
        EXPECT_GE(number - 10, bars.back() + 14);
        EXPECT_LE(number, name[0] - 10);
    }
}

TEST(PassTimes, PassesOfOneKindAreSummed) {
    Comparison made = make_usual_comparison();
    made.rows[0].passes = {{"capture/1", make_time_samples(3)},
                           {"capture/2", make_time_samples(4)},
                           {"view", make_time_samples(2)}};
    made.rows[1].passes = {{"shadow", make_time_samples(5)}, {"view", make_time_samples(1)}};
    made.rows[2].passes.clear();
    made.rows.resize(3);
    const StackedBars chart = pass_time_bars(made);
    ASSERT_EQ(chart.kinds.size(), 3U);
    EXPECT_EQ(chart.kinds[0].name, "capture");
    EXPECT_EQ(chart.kinds[1].name, "view");
    EXPECT_EQ(chart.kinds[2].name, "shadow");
    ASSERT_EQ(chart.bars.size(), 2U); // a row without passes has no bar
    EXPECT_EQ(chart.bars[0].label, "naive:bounces=0");
    EXPECT_THAT(chart.bars[0].lengths, ElementsAre(7, 2, 0));
    EXPECT_THAT(chart.bars[1].lengths, ElementsAre(0, 1, 5));
    const std::string text = to_markdown(made);
    EXPECT_THAT(text, HasSubstr("## Time by pass, ms"));
    EXPECT_TRUE(
        std::regex_search(text, std::regex(R"(\| naive:bounces=0 +\| +7\.00 \| +2\.00 \| +– \|)")))
        << text;
}

/// Returns a comparison of 64x48 pixels whose rows differ only in the pixels from (40, 20) to
/// (43, 23).
Comparison make_comparison_with_one_difference() {
    Comparison made = make_usual_comparison();
    made.width = 64, made.height = 48;
    made.reference_display = Picture(64, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) made.reference_display.at(x, y) = vec3(x, y, 0) / 255.0F;
    for (Row& row : made.rows) {
        row.display = made.reference_display;
        row.flip_map.assign(64UL * 48, .5F); // everywhere wrong, but equally
    }
    for (int y = 20; y < 24; ++y)
        for (int x = 40; x < 44; ++x) made.rows[1].flip_map[y * 64UL + x] = 1;
    return made;
}

TEST(Figures, CropShowsWhereTheRowsDiffer) {
    Comparison made = make_comparison_with_one_difference();
    const std::optional<PixelRectangle> found = choose_crop(made);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->size, ivec2(16));
    EXPECT_LE(found->corner.x, 40);
    EXPECT_LE(found->corner.y, 20);
    EXPECT_GE(found->corner.x + 16, 44);
    EXPECT_GE(found->corner.y + 16, 24);
    made.rows.resize(1);
    EXPECT_FALSE(choose_crop(made));
}

class FiguresOfComparison : public test::InFolder {};

TEST_F(FiguresOfComparison, CropsHoldThePixelsThatTheCaptionNames) {
    const Comparison made = make_comparison_with_one_difference();
    write_figures(made, folder, PixelRectangle{{10, 5}, {32, 16}});
    const Picture crop = measure::read_picture(folder / "crop-reuse.png");
    ASSERT_EQ(crop.width, 512); // 16 times
    ASSERT_EQ(crop.height, 256);
    const auto expect_pixel = [&](int x, int y) {
        EXPECT_EQ(crop.at(x, y), crop.at(x - x % 16, y - y % 16));
        const vec3 shown = measure::to_display(crop).at(x, y) * 255.0F;
        EXPECT_EQ(shown, vec3(10 + x / 16, 5 + y / 16, 0)) << x << " " << y;
    };
    expect_pixel(0, 0);
    expect_pixel(511, 255);
    expect_pixel(100, 77);
    const std::string tex = read_file(folder / "figures.tex");
    EXPECT_THAT(tex, HasSubstr("from (10, 5) to (41, 20), enlarged 16 times"));
    EXPECT_THAT(tex, HasSubstr("crop-reuse.png"));
    EXPECT_THAT(tex, HasSubstr("{\\tiny naive:bounces=0}"));
    EXPECT_THAT(tex, HasSubstr("reuse & 7.00 & 7.00--7.00 & 0.2000 & 0.0900 \\\\"));
    EXPECT_THAT(tex, Not(HasSubstr("causes"))); // no row has causes
    EXPECT_FALSE(fs::exists(folder / "causes.svg"));
    for (const char* name : {"plot.svg", "passes.svg"}) {
        const std::string svg = read_file(folder / name);
        EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=")) << svg;
        EXPECT_THAT(svg, HasSubstr("<style>"));
    }
}

TEST_F(FiguresOfComparison, BarsOfCausesAreInProportionToTheirShares) {
    Comparison made = make_comparison_with_one_difference();
    auto causes = std::make_shared<measure::Causes>();
    const std::string first(cause_colours()[0].cause);
    const std::string third(cause_colours()[2].cause);
    causes->list = {{.name = third, .share = .2}, {.name = first, .share = .8}};
    made.rows[1].causes = causes;
    write_figures(made, folder, {});
    EXPECT_THAT(read_file(folder / "figures.tex"), HasSubstr("causes"));
    const std::string svg = read_file(folder / "causes.svg");
    const std::vector<double> widths = list_bar_widths(svg);
    ASSERT_EQ(widths.size(), 2U) << "only one row has causes";
    EXPECT_NEAR(widths[0], 4 * widths[1], .05);
    EXPECT_THAT(svg, HasSubstr(": " + first + ", 80</title>"));
    EXPECT_THAT(svg, HasSubstr(": " + third + ", 20</title>"));
    EXPECT_THAT(svg, HasSubstr(">" + made.rows[1].label + "</text>"));
    EXPECT_THAT(svg, Not(HasSubstr(">" + made.rows[0].label + "</text>")));
}

TEST_F(FiguresOfComparison, NamesWithSpecialCharactersAreEscaped) {
    Comparison made = make_comparison_with_one_difference();
    made.scene.name = "50% & #1_a\\{b}~^$";
    write_figures(made, folder, {});
    EXPECT_THAT(read_file(folder / "figures.tex"),
                HasSubstr("scene 50\\% \\& \\#1\\_a\\textbackslash{}\\{b\\}\\~{}\\^{}\\$,"));
}

TEST_F(FiguresOfComparison, CropOutsideThePictureIsRefused) {
    const Comparison made = make_comparison_with_one_difference();
    for (const PixelRectangle& crop :
         {PixelRectangle{{60, 0}, {5, 5}}, PixelRectangle{{0, 44}, {5, 5}},
          PixelRectangle{{-1, 0}, {5, 5}}, PixelRectangle{{0, 0}, {0, 5}}})
        test::expect_error(
            [&] { write_figures(made, folder, crop); }, Failure::usage,
            {"--crop", "64x48",
             fmt::format("{},{},{},{}", crop.corner.x, crop.corner.y, crop.size.x, crop.size.y)});
    EXPECT_TRUE(fs::is_empty(folder));
}

} // namespace
