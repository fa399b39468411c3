#include "report/writer.hpp"

#include "report_sample.hpp"

#include <gmock/gmock.h>

#include <regex>

namespace {

using catoptric::report::Comparison;
using catoptric::report::Row;
using catoptric::report::to_csv;
using namespace catoptric::report::sample;
using testing::HasSubstr;
using testing::Not;

TEST(ReportMarkdown, MarkdownShowsTheSeedTableBesideMeasuredRows) {
    const std::string text = report_text_of_comparison(make_usual_comparison());
    EXPECT_TRUE(std::regex_search(
        text,
        std::regex(
            R"(\| Part one +\| +0 \| +2 \| +93 \| +10\.8 \| naive:bounces=0 +\| +6 \| +26 \| +2\.00 \|)")))
        << text;
    EXPECT_TRUE(std::regex_search(
        text, std::regex(R"(\| Part one +\| +4 \| +18 \| +37 \| +27\.0 \| not in this run)")));
    EXPECT_TRUE(
        std::regex_search(text, std::regex(R"(\| ray trace +\| +– \| +– \| +10\.7 \| +93\.0 \|)")));
    EXPECT_THAT(text, HasSubstr("## Mirror by mirror"));
    EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(ReportMarkdown, MarkdownMatchesSeedRowsOnlyWithDefaultKnobs) {
    Comparison made = make_usual_comparison();
    const std::regex traced(R"(93\.0 \| raytrace:depth=8 +\|)"), reused(R"(7\.4 \| reuse +\|)");
    EXPECT_FALSE(std::regex_search(report_text_of_comparison(made), traced));
    EXPECT_TRUE(std::regex_search(report_text_of_comparison(made), reused));
    made.rows.push_back(
        make_row("raytrace:depth=8", 10, 0.001, 0.001,
                 {make_number_setting("depth", 8), make_choice_setting("sphere", "mesh")}));
    made.rows[1].settings = {make_number_setting("face", 512, true)};
    EXPECT_TRUE(std::regex_search(report_text_of_comparison(made), traced));
    EXPECT_FALSE(std::regex_search(report_text_of_comparison(made), reused));
    EXPECT_THAT(
        report_text_of_comparison(made),
        HasSubstr(
            "here raytrace:depth=8 takes 1.67 times as long (95 %: 1.67 to 1.67) as parallax"));
}

TEST(ReportMarkdown, MarkdownExplainsTimesOfASoftwareDriver) {
    Comparison made = make_usual_comparison();
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("processor time")));
    made.device.type = "cpu";
    made.device.threads = 2;
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("time of its software driver"))
        << "rows that share frames have no processor time of their own";
    for (Row& row : made.rows) row.on_processor = true, row.cpu_ms = row.gpu_ms;
    made.warnings = {"no light: ambient only"};
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("processor time of its software driver"));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("2 threads"));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("no light: ambient only"));
}

TEST(ReportMarkdown, MarkdownDescribesTheFrontInWords) {
    const std::string text = report_text_of_comparison(make_usual_comparison());
    EXPECT_THAT(
        text, HasSubstr("naive:bounces=0 (2.00 ms, FLIP 0.5000); parallax (6.00 ms, FLIP 0.1000); "
                        "raytrace:depth=16 (12.0 ms, FLIP 0)"));
    EXPECT_THAT(text, HasSubstr("parallax beats reuse (7.00 ms, FLIP 0.2000)."));
    EXPECT_THAT(text, HasSubstr("no ray-traced row beats"));
}

TEST(ReportMarkdown, MarkdownSaysWhichRowsRayTracingBeats) {
    Comparison made = make_usual_comparison();
    made.rows[3].gpu_ms = make_time_samples(5);
    made.pareto = {0, 3};
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("On this device, Card, ray tracing beats 2 of the 3 other rows: all but "
                          "naive:bounces=0."));
    made.rows[3].gpu_ms = make_time_samples(1);
    made.pareto = {3};
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("ray tracing beats every other row, 3 of 3."));
    made.rows[3].error.nonfinite = 1; // a failed row beats no row
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("no ray-traced row beats"));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("raytrace:depth=16 failed"));
}

/// The device and the winning technique come first, because readers ask for them first.
TEST(ReportWords, VerdictAndDeviceComeFirstInReports) {
    using catoptric::report::to_html;
    Comparison made = make_usual_comparison();
    const std::string verdict = "On this device, Card, no ray-traced row beats any other row.";
    EXPECT_LT(report_text_of_comparison(made).find(verdict),
              report_text_of_comparison(made).find("**Scene**"));
    EXPECT_LT(to_html(made).find(verdict), to_html(made).find("Fastest"));
    made.rows.pop_back(); // removes the ray-traced row
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("On this device, Card, fastest is naive:bounces=0, closest is "
                          "parallax (6.00 ms, FLIP 0.1000)."));
}

/// A time means little without its device, so the report names the device beside times.
TEST(ReportMarkdown, MarkdownNamesTheDeviceBesideTimes) {
    Comparison made = make_usual_comparison();
    made.device.name = "llvmpipe (LLVM 15.0.6, 256 bits)";
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("| ms, GTX 770 |"));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("| ms, llvmpipe |"));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("Every row, times on llvmpipe (LLVM 15.0.6, 256 bits)"));
}

/// Smooth dielectrics whose reflections no row draws are the first remark of the report. Without
/// such pixels, the report does not mention them.
TEST(ReportMarkdown, MarkdownFirstNamesSurfacesThatNoRowDraws) {
    Comparison made = make_usual_comparison();
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("smooth dielectrics")))
        << "no column without a pixel";
    EXPECT_THAT(to_csv(made), Not(HasSubstr("dielectrics_flip")));
    for (Row& row : made.rows) {
        row.error_dielectrics = make_difference_of_errors(.05, .25),
        row.error_dielectrics.pixels = 35;
        row.error_all.pixels = 100;
    }
    made.rows[2].error_dielectrics.flip = .125;
    made.rows[3].rays.reset();
    const std::string capture = report_text_of_comparison(made);
    EXPECT_THAT(capture, HasSubstr("- Not drawn: 35 % of the pixels show smooth surfaces that are "
                                   "no mirrors, and no row draws what they reflect. Over these "
                                   "pixels the other rows' FLIP is 0.1250 at best (parallax)."));
    EXPECT_LT(capture.find("Not drawn: "), capture.find("Clears: "));
    EXPECT_THAT(capture, HasSubstr("FLIP, smooth dielectrics"));
    EXPECT_THAT(to_csv(made), HasSubstr("dielectrics_flip"));
    made.rows[3].rays.emplace();
    made.rows[3].error_dielectrics.flip = 0;
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("no row but raytrace:depth=16 draws what they reflect. Over "
                          "these pixels the other rows' FLIP is 0.1250"));
}

TEST(ReportMarkdown, MarkdownCallsATieIfNeitherRowWinsEveryRound) {
    Comparison made = make_usual_comparison();
    made.rows[1].gpu_ms = make_time_samples(6.5, .1);
    made.rows[1].error.flip = made.rows[2].error.flip; // `reuse`: FLIP of `parallax`, 8 % slower
    made.pareto = {0, 2, 1, 3};
    std::string text = report_text_of_comparison(made);
    EXPECT_THAT(text, Not(HasSubstr("beats reuse")));
    EXPECT_THAT(text, HasSubstr("takes as long as part two (6.00 against 6.50 ms: round by round "
                                "neither is the faster, they are not told apart"));
    made.rows[1].gpu_ms = make_time_samples(7.5, .1); // rounds of 6.75 ms or more; `parallax`: 6 ms
    made.pareto = {0, 2, 3};
    text = report_text_of_comparison(made);
    EXPECT_THAT(text, HasSubstr("parallax beats reuse"));
    EXPECT_THAT(text,
                HasSubstr("takes 20 % less time than part two (6.00 against 7.50 ms), 0.800 times "
                          "as much (95 %: 0.727 to 0.889)"));

    made.rows.push_back(
        make_row("raytrace:depth=8", 6.3, 0.001, 0.001,
                 {make_number_setting("depth", 8), make_choice_setting("sphere", "mesh")}));
    made.rows.back().gpu_ms = make_time_samples(6.3, .1);
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("here raytrace:depth=8 takes as long as parallax (6.30 against "
                          "6.00 ms: round by round neither is the faster"));
    made.rows.back().gpu_ms = make_time_samples(9, .1);
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("here raytrace:depth=8 takes 1.50 times as long (95 %: 1.35 "
                          "to 1.65) as parallax"));
}

TEST(ReportMarkdown, MarkdownNamesRowsThatOnlyBeatenRowsBeat) {
    // The times of `parallax` and `reuse` are equal within 5 %, and `parallax` has less error, so
    // it beats `reuse`. In the same way `secant` beats `parallax`. But `secant` takes 8 % more time
    // than `reuse` and does not beat it.
    Comparison made = make_comparison({make_row("reuse", 10, .1, .3),
                                       make_row("parallax", 10.4, .1, .2),
                                       make_row("secant", 10.8, .1, .1)});
    made.pareto = {2};
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("secant beats parallax (10.4 ms, FLIP 0.2000)."));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("Beaten only by rows that are beaten themselves: reuse (10.0 ms"));
}

/// A row that leaves its mirrors black draws no reflections, so the report never calls it the
/// fastest.
TEST(ReportHtml, HtmlReportNeverCallsBlackMirrorsFastest) {
    using catoptric::report::to_html;
    Comparison made = make_usual_comparison();
    EXPECT_THAT(to_html(made), HasSubstr("Fastest</dt><dd>2.00 ms <small>naive:bounces=0"));
    made.rows[0].mirrors_black = true;
    made.rows[1].gpu_ms = make_time_samples(7, .2);
    EXPECT_THAT(to_html(made), HasSubstr("<dt>May be fastest</dt><dd>2 rows <small>of 3"));
    made.rows[1].gpu_ms = make_time_samples(8);
    EXPECT_THAT(to_html(made), HasSubstr("Fastest</dt><dd>6.00 ms <small>parallax"));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("since their mirrors are black: naive:bounces=0 (2.00 ms, FLIP "
                          "0.5000)."));
}

TEST(ReportMarkdown, ReportMentionsTheSeedReportOnlyForTheSeedScene) {
    using catoptric::report::to_html;
    Comparison made = make_usual_comparison();
    made.rows.push_back(make_naive_row(1, 7, 0.0880, 0.2));
    made.rows.push_back(make_naive_row(2, 9, 0.0871, 0.2));
    for (const char* words : {"seed report's Table 1", "What this says of the seed report",
                              "GTX 770", "in the seed report, part three takes"})
        EXPECT_THAT(report_text_of_comparison(made) + to_html(made), HasSubstr(words));
    made.scene.is_seed = false;
    for (const char* words : {"seed report", "GTX 770", "the report "}) {
        EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr(words)));
        EXPECT_THAT(to_html(made), Not(HasSubstr(words)));
    }
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("Inter-reflections: with i = 1 to 2"));
}

TEST(ReportMarkdown, MarkdownSaysWhetherClearsExplainTheSeedTimes) {
    Comparison made = make_usual_comparison(); // `naive:bounces=0` takes 2 ms, `reuse` takes 7 ms
    EXPECT_THAT(
        report_text_of_comparison(made),
        HasSubstr("is not slower than part two (2.00 against 7.00 ms); what a clear costs"));
    made.clear_ms = make_time_samples(1);
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("Clearing the cubes of all mirrors costs 1.00 ms"));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("clearing alone does not explain the report's order on this device"));
    made.clear_ms = make_time_samples(8);
    EXPECT_THAT(
        report_text_of_comparison(made),
        HasSubstr("43 % behind part two (the report: 46 %), so clearing alone does explain"));
    made.rows[0].gpu_ms = make_time_samples(9);
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("is slower than part two"));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("slower without any clear, so clearing alone does not explain"));
    made.rows.erase(made.rows.begin());
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("Clears:")));
}

TEST(ReportMarkdown, MarkdownComparesFormatsOfStoredDistances) {
    Comparison made = make_usual_comparison();
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("Stored distance")));
    made.rows.push_back(make_unorm8_row(1000, 0.035));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("0.0350 with 8 bits up to 1000 units."));
    made.rows.push_back(make_unorm8_row(200, 0.0961));
    EXPECT_THAT(
        report_text_of_comparison(made),
        HasSubstr(
            "is 0.0900 without correction, 0.0300 corrected with 32-bit distances, 0.0961 with "
            "8 bits up to 200 units as in the report, 0.0350 with 8 bits"));
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("its figure 7 cannot have been made that way in these units"));
    made.rows.back().error.rmse = 0.05;
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("still helps"));
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("cannot have been made")));
}

TEST(ReportMarkdown, MarkdownSaysWhetherInterReflectionsHelp) {
    Comparison made = make_usual_comparison();
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("Inter-reflections:")));
    made.rows.push_back(make_naive_row(1, 7, 0.0880, 0.2));
    made.rows.push_back(make_naive_row(2, 9, 0.0871, 0.2));
    made.rows.push_back(make_naive_row(3, 11, 0.0870, 0.2));
    EXPECT_THAT(
        report_text_of_comparison(made),
        HasSubstr(
            "with i = 1 to 3 the rmse of part one over the mirrors is 0.0880, 0.0871, 0.0870"));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("parallax dominates what is left"));
    made.rows[2].error.rmse = 0.08;
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("parallax dominates")));
    made.rows.back().error.rmse = 0.05;
    EXPECT_THAT(report_text_of_comparison(made),
                HasSubstr("bring it closer to the reference, by 0.0380 in all"));
}

TEST(ReportMarkdown, MarkdownEscapesNamesInTableCells) {
    Comparison made = make_usual_comparison();
    made.scene.name = "a|b\n# <b>c</b>";
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("a\\|b \\# \\<b\\>c\\</b\\>"));
}

/// Times measured while other programs used the processors are not reliable. The report must name
/// such rows at its top.
TEST(ReportMarkdown, ReportNamesNoisyRowsAtTheTop) {
    using catoptric::report::to_html;
    Comparison made = make_usual_comparison();
    EXPECT_THAT(report_text_of_comparison(made), Not(HasSubstr("oisy")));
    made.rows[1].noisy = made.rows[2].noisy = true;
    const std::string words = "Noisy: 2 of 4 rows had to wait for a processor";
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr(words));
    EXPECT_THAT(report_text_of_comparison(made), HasSubstr("not to be trusted: reuse, parallax."));
    EXPECT_LT(report_text_of_comparison(made).find(words),
              report_text_of_comparison(made).find("| reuse"));
    EXPECT_LT(to_html(made).find(words), to_html(made).find("<main>"));
    EXPECT_THAT(to_html(made), HasSubstr("<span class=\"badge\">noisy</span>"));
}

/// Rows that tie in time share a place in the table.
TEST(ReportMarkdown, MarkdownGivesTiedRowsTheSamePlace) {
    Comparison made = make_usual_comparison(); // the four rows take 2, 7, 6 and 12 ms
    EXPECT_TRUE(std::regex_search(
        report_text_of_comparison(made),
        std::regex(R"(\| reuse +\| +3 \| +6 \| +26 \| +7\.00 \| +7\.00–7\.00 \|)")))
        << report_text_of_comparison(made);
    made.rows[1].gpu_ms = make_time_samples(7, .2);
    EXPECT_TRUE(std::regex_search(
        report_text_of_comparison(made),
        std::regex(R"(\| reuse +\| +2–3 \| +6 \| +26 \| +7\.00 \| +5\.60–8\.40 \|)")))
        << report_text_of_comparison(made);
    EXPECT_TRUE(std::regex_search(report_text_of_comparison(made),
                                  std::regex(R"(\| parallax +\| +2–3 \|)")));
}

} // namespace
