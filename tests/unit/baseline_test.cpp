// Tests of comparing a report with an earlier report.json. Each quantity of a row is worse, kept or
// unknown.
#include "measure/halves.hpp"
#include "measure/statistics.hpp"
#include "measure/work.hpp"
#include "report/baseline.hpp"
#include "report_sample.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace {

using namespace catoptric::report;
using catoptric::Error;
using catoptric::Failure;
using catoptric::measure::summarise;
using catoptric::report::sample::make_usual_comparison;
using testing::HasSubstr;

/// Returns six rounds of one frame each whose times are `ms` times 0.98 to 1.02.
catoptric::measure::SampleSummary make_six_timed_rounds(double ms) {
    std::vector<std::vector<double>> rounds;
    for (const double factor : {.98, .99, 1.0, 1.0, 1.01, 1.02}) rounds.push_back({ms * factor});
    return summarise(rounds);
}

/// Returns a comparison of two rows of 10 ms and 20 ms. The second row has passes of 5 ms and 15
/// ms.
Comparison make_timed_comparison() {
    Comparison made = make_usual_comparison();
    made.rows.resize(2);
    for (Row& row : made.rows) row.passes.clear();
    made.rows[0].gpu_ms = make_six_timed_rounds(10),
    made.rows[1].gpu_ms = make_six_timed_rounds(20);
    made.rows[1].passes = {{"capture", make_six_timed_rounds(5)},
                           {"search", make_six_timed_rounds(15)}};
    made.clear_ms = make_six_timed_rounds(1);
    return made;
}

std::vector<BaselineFinding> judge(const Comparison& now, const Comparison& before,
                                   const BaselineLimits& limits = {}) {
    return judge_comparison(now, to_json(before), "old.json", limits);
}

std::vector<std::string> list_quantities_with_verdict(const std::vector<BaselineFinding>& findings,
                                                      BaselineVerdict verdict) {
    std::vector<std::string> list;
    for (const BaselineFinding& finding : findings)
        if (finding.verdict == verdict) list.push_back(finding.row + ": " + finding.quantity);
    return list;
}

using Names = std::vector<std::string>;

TEST(Baseline, EqualComparisonIsKept) {
    const Comparison made = make_timed_comparison();
    const std::vector<BaselineFinding> findings = judge(made, made);
    EXPECT_EQ(findings.size(), 6U); // FLIP and time of two rows, and the times of two passes
    EXPECT_EQ(list_quantities_with_verdict(findings, BaselineVerdict::kept).size(), 6U);
    EXPECT_EQ(format_findings(findings), "baseline: 0 worse, 0 unknown, 6 kept\n");
}

TEST(Baseline, SlowerPassIsNamedWithItsRow) {
    const Comparison before = make_timed_comparison();
    Comparison now = before;
    now.rows[1].passes[1].gpu_ms = make_six_timed_rounds(15 * 1.2);
    now.rows[1].gpu_ms = make_six_timed_rounds(20 * 1.15);
    const std::string row = before.rows[1].label;
    // Both intervals are 2 % wide to each side, so the least ratios are 1.2 / 1.0284 = 1.167 and
    // 1.15 / 1.0284 = 1.118. Both are above the limit 1.1.
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse),
              (Names{row + ": ms", row + ": ms of search"}));
    EXPECT_THAT(format_findings(judge(now, before)),
                HasSubstr("worse: " + row +
                          ", ms of search: 18.0 ms, before 15.0 ms: 1.17 to 1.23 "
                          "times with 95 % confidence; at most 1.1 times"));
    // With a limit of 1.3 all times are kept. With a limit of 1.2, the intervals contain the limit,
    // so the verdict is unknown.
    EXPECT_TRUE(list_quantities_with_verdict(judge(now, before, {.max_time_ratio = 1.3}),
                                             BaselineVerdict::worse)
                    .empty());
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before, {.max_time_ratio = 1.2}),
                                           BaselineVerdict::unknown),
              (Names{row + ": ms of search"}));
    // A row that became faster is never worse.
    EXPECT_EQ(list_quantities_with_verdict(judge(before, now), BaselineVerdict::kept).size(), 6U);
}

TEST(Baseline, ShortPassIsNotJudged) {
    Comparison before = make_timed_comparison();
    before.rows[1].passes.push_back({"clear", make_six_timed_rounds(.6)}); // a pass of .6 ms in a
                                                                           // row of 20 ms
    Comparison now = before;
    now.rows[1].passes[2].gpu_ms = make_six_timed_rounds(.9);
    EXPECT_EQ(judge(now, before).size(), 6U);
    EXPECT_TRUE(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse).empty());
    now.rows[1].passes[2].gpu_ms = make_six_timed_rounds(1.2); // now 6 % of the row's time
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse),
              (Names{before.rows[1].label + ": ms of clear"}));
}

TEST(Baseline, SlowMachineAnotherDeviceAndNoiseSayNothingOfTimes) {
    const Comparison before = make_timed_comparison();
    Comparison slow = before;
    for (Row& row : slow.rows) row.gpu_ms = make_six_timed_rounds(row.gpu_ms.median * 1.3);
    slow.clear_ms = make_six_timed_rounds(1.3); // constant work takes longer by the same factor
    EXPECT_TRUE(list_quantities_with_verdict(judge(slow, before), BaselineVerdict::worse).empty());
    EXPECT_TRUE(list_quantities_with_verdict(judge(slow, before, {.max_time_ratio = 1.2}),
                                             BaselineVerdict::unknown)
                    .empty())
        << "passes and rows are 1 to 1.3 times as slow on a machine that is 1.3 times as slow";
    slow.clear_ms = before.clear_ms;
    EXPECT_EQ(list_quantities_with_verdict(judge(slow, before), BaselineVerdict::worse).size(), 2U);
    Comparison other = slow;
    other.device.name = "another";
    EXPECT_TRUE(list_quantities_with_verdict(judge(other, before), BaselineVerdict::worse).empty());
    EXPECT_EQ(list_quantities_with_verdict(judge(other, before), BaselineVerdict::unknown).size(),
              4U);
    other = slow, other.device.threads = 16; // a processor of the same name with another number of
                                             // threads
    EXPECT_TRUE(list_quantities_with_verdict(judge(other, before), BaselineVerdict::worse).empty());
    Comparison noisy = slow;
    noisy.rows[0].noisy = true;
    EXPECT_EQ(list_quantities_with_verdict(judge(noisy, before), BaselineVerdict::worse),
              (Names{before.rows[1].label + ": ms"}));
    Comparison short_run = slow;
    short_run.rows[0].gpu_ms = summarise(std::vector<std::vector<double>>{{99}});
    EXPECT_EQ(list_quantities_with_verdict(judge(short_run, before), BaselineVerdict::unknown),
              (Names{before.rows[0].label + ": ms"}));
}

TEST(Baseline, RiseOfFlipIsWorseAboveTheShareAndAboveTheNoise) {
    const Comparison before = make_timed_comparison();
    Comparison now = before;
    now.rows[0].error.flip = before.rows[0].error.flip * 1.05;
    const Names row{before.rows[0].label + ": flip"};
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse), row);
    EXPECT_TRUE(list_quantities_with_verdict(judge(now, before, {.max_flip_rise = .06}),
                                             BaselineVerdict::worse)
                    .empty());
    now.noise = std::make_shared<catoptric::measure::ReferenceNoise>();
    now.noise->flip_floor = before.rows[0].error.flip * .06;
    EXPECT_TRUE(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse).empty());
    now.noise->flip_floor = before.rows[0].error.flip * .04;
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse), row);
    // If a row had no error before, any error is worse.
    Comparison exact = before, inexact = before;
    exact.rows[0].error.flip = 0, inexact.rows[0].error.flip = 1e-5;
    EXPECT_EQ(list_quantities_with_verdict(judge(inexact, exact), BaselineVerdict::worse), row);
}

/// Counts of work are the same in each run. A count above the limit is therefore worse, also on
/// another device or a noisy machine.
TEST(Baseline, MoreCountedWorkIsWorse) {
    const auto with_work = [](double nodes) {
        auto json = nlohmann::ordered_json::parse(to_json(make_timed_comparison()));
        for (auto& row : json["rows"]) row["work"] = {{"nodes", nodes}, {"draws", 6}};
        return json.dump();
    };
    Comparison now = make_timed_comparison();
    for (Row& row : now.rows) {
        catoptric::WorkCounts counts{};
        counts[catoptric::WorkKind::nodes] = 120;
        catoptric::measure::set_work(row, {{"view", counts}});
    }
    now.device.name = "another", now.studies.emplace_back("work");
    const auto judge_nodes = [&](double nodes) {
        return list_quantities_with_verdict(judge_comparison(now, with_work(nodes), "old.json", {}),
                                            BaselineVerdict::worse);
    };
    const Names both{now.rows[0].label + ": work: nodes", now.rows[1].label + ": work: nodes"};
    EXPECT_EQ(judge_nodes(100), both);
    EXPECT_EQ(judge_nodes(115), Names{});
    EXPECT_EQ(judge_nodes(0), both);
}

TEST(Baseline, MissingRowFailsAndNewRowIsSaidApart) {
    const Comparison before = make_timed_comparison();
    Comparison now = before;
    now.rows.pop_back();
    const Names second{before.rows[1].label + ": row"};
    std::vector<BaselineFinding> findings = judge(now, before);
    EXPECT_EQ(list_quantities_with_verdict(findings, BaselineVerdict::worse), Names{});
    EXPECT_EQ(list_quantities_with_verdict(findings, BaselineVerdict::missing), second);
    EXPECT_TRUE(std::ranges::any_of(findings, is_failure));
    EXPECT_EQ(format_findings(findings),
              "missing: " + before.rows[1].label +
                  ", row: is in the baseline, and not in this comparison\n"
                  "baseline: 0 worse, 1 missing, 0 unknown, 2 kept\n");
    EXPECT_THAT(to_junit(findings, "s"), HasSubstr("failures=\"1\""));
    EXPECT_THAT(to_markdown(findings, "s"), HasSubstr("worse than the baseline"));

    findings = judge(before, now);
    EXPECT_EQ(list_quantities_with_verdict(findings, BaselineVerdict::added), second);
    EXPECT_FALSE(std::ranges::any_of(findings, is_failure));
    EXPECT_EQ(format_findings(findings), "added: " + before.rows[1].label +
                                             ", row: is not in the baseline, and not judged\n"
                                             "baseline: 0 worse, 0 unknown, 2 kept, 1 added\n");
    EXPECT_THAT(to_junit(findings, "s"), HasSubstr("failures=\"0\""));
    EXPECT_THAT(to_markdown(findings, "s"), HasSubstr("| added | "));
}

/// A technique whose settings changed has another label. It takes the place of its earlier row
/// where it errs no more.
TEST(Baseline, NewRowOfTheSameTechniqueReplacesAMissingRowIfItErrsNoMore) {
    const Comparison before = make_timed_comparison();
    Comparison now = before;
    now.rows[1].label += ":face=512";
    for (const double factor : {.9, 1.0}) {
        now.rows[1].error.flip = factor * before.rows[1].error.flip;
        const std::vector<BaselineFinding> findings = judge(now, before);
        EXPECT_EQ(list_quantities_with_verdict(findings, BaselineVerdict::replaced),
                  (Names{before.rows[1].label + ": row"}));
        EXPECT_FALSE(std::ranges::any_of(findings, is_failure));
        EXPECT_THAT(format_findings(findings),
                    HasSubstr("whose new row " + now.rows[1].label + " errs no more\n"));
    }
    now.rows[1].error.flip = 1.01 * before.rows[1].error.flip;
    EXPECT_TRUE(std::ranges::any_of(judge(now, before), is_failure));
    now.rows[1].error.flip = 0, now.rows[1].technique = "another";
    EXPECT_TRUE(std::ranges::any_of(judge(now, before), is_failure));
}

/// Programs beside the comparison lengthen its device times, and not its processor time.
TEST(Baseline, TimesOnAProcessorAreProcessorTimes) {
    Comparison before = make_timed_comparison();
    before.device.type = "cpu";
    for (Row& row : before.rows) row.on_processor = true, row.cpu_ms = row.gpu_ms;
    Comparison now = before;
    now.rows[0].gpu_ms = make_six_timed_rounds(100);
    now.rows[1].cpu_ms = make_six_timed_rounds(20 * 1.3);
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse),
              (Names{before.rows[1].label + ": ms"}));
    EXPECT_THAT(format_findings(judge(now, before)),
                HasSubstr("26.0 ms of processor time, before 20.0 ms"));
    before.rows[0].cpu_ms = {}; // an older report
    EXPECT_EQ(list_quantities_with_verdict(judge(now, before), BaselineVerdict::worse),
              (Names{before.rows[0].label + ": ms", before.rows[1].label + ": ms"}));
}

TEST(Baseline, OtherSceneSizeOrDocumentIsRefused) {
    const Comparison before = make_timed_comparison();
    const auto refusal = [&](const Comparison& now, const std::string& json) -> std::string {
        try {
            judge_comparison(now, json, "old.json", {});
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::bad_data);
            return error.what();
        }
        return "";
    };
    Comparison other = before;
    other.scene.hash = "feed";
    EXPECT_EQ(refusal(other, to_json(before)),
              "old.json: wanted a baseline with the same scene.hash as now (\"feed\"), found "
              "'\"deadbeef\"'");
    other = before, other.width = 5;
    const auto size = [](const Comparison& comparison) {
        return "[" + std::to_string(comparison.width) + "," + std::to_string(comparison.height) +
               "]";
    };
    EXPECT_EQ(refusal(other, to_json(before)),
              "old.json: wanted a baseline with the same size as now (" + size(other) +
                  "), found '" + size(before) + "'");
    other = before, other.reference_label = "raytrace:depth=2";
    EXPECT_THAT(refusal(other, to_json(before)), HasSubstr("the same reference.label as now"));
    other = before, other.complete = false;
    EXPECT_THAT(refusal(before, to_json(other)), HasSubstr("wanted a complete report"));
    for (const char* json : {"[]", "{}", "null", R"({"schema": "catoptric/plan/1"})"})
        EXPECT_THAT(refusal(before, json),
                    HasSubstr("wanted a report.json of 'catoptric compare'"));
    EXPECT_THAT(refusal(before, R"({"schema": "catoptric/compare-scenes/1", "scenes": [1, {}]})"),
                HasSubstr("wanted the scene "));
    // A baseline that was changed by hand is refused as a whole, with the place.
    const auto changed = [&](const char* pointer, const nlohmann::ordered_json& value) {
        auto json = nlohmann::ordered_json::parse(to_json(before));
        json[nlohmann::ordered_json::json_pointer(pointer)] = value;
        return json.dump();
    };
    EXPECT_EQ(refusal(before, changed("/rows/1/label", 3)),
              "old.json: rows[1]: wanted a row with a label, found an object");
    EXPECT_EQ(refusal(before, changed("/rows/1/error/flip", "small")),
              "old.json: rows[1].error.flip: wanted a number or null, found '\"small\"'");
    EXPECT_EQ(refusal(before, changed("/rows/0/gpu_ms/ci95", "wide")),
              "old.json: rows[0].gpu_ms.ci95: wanted two numbers or null, found '\"wide\"'");
    EXPECT_EQ(refusal(before, changed("/rows/1/passes/0/name", nullptr)),
              "old.json: rows[1].passes[0]: wanted a pass with a name, found an object");
    EXPECT_THAT(refusal(before, changed("/rows/0", 1)), HasSubstr("old.json: rows[0]: wanted"));
    other = before, other.timing = "pipelined";
    EXPECT_THAT(refusal(other, to_json(before)), HasSubstr("the same timing as now"));
    EXPECT_THAT(refusal(before, "{"), HasSubstr("old.json"));
}

TEST(Baseline, FilesForPipelinesHoldEveryFinding) {
    const Comparison before = make_timed_comparison();
    Comparison now = before;
    now.rows[0].error.flip *= 2;
    now.rows[1].noisy = true;
    const std::vector<BaselineFinding> findings = judge(now, before);
    const std::string xml = to_junit(findings, "a<b"), markdown = to_markdown(findings, "a|b");
    EXPECT_THAT(xml, HasSubstr("<testsuite name=\"a&lt;b\" tests=\"6\" failures=\"1\" "
                               "skipped=\"3\">"));
    const auto count = [&](const std::string& tag) {
        std::size_t found = 0;
        for (std::size_t at = xml.find(tag); at != xml.npos; at = xml.find(tag, at + 1)) ++found;
        return found;
    };
    EXPECT_EQ(count("<testcase "), 6U);
    EXPECT_EQ(count("<failure "), 1U);
    EXPECT_EQ(count("<skipped "), 3U);
    EXPECT_EQ(count("</testcase>"), 4U);
    EXPECT_THAT(markdown, HasSubstr("### a\\|b: worse than the baseline"));
    EXPECT_THAT(markdown,
                HasSubstr("\n| verdict | row | quantity | |\n|---|---|---|---|\n| worse | "));
    EXPECT_THAT(markdown, HasSubstr("| worse | naive"));
    EXPECT_THAT(markdown, HasSubstr("baseline: 1 worse, 3 unknown, 2 kept"));
}

} // namespace
