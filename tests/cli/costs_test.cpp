// Tests of counted work and of predicted times on the command line: figures in the written files,
// and refused options.
#include "cli/program.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* kDeviceCostsJson = R"({
  "schema": "catoptric/costs/1", "device": "card", "origin": "given",
  "costs": [{"work": "camera_rays", "ns": 100, "range": [50, 200]},
            {"work": "fragments", "ns": 1},
            {"work": "frames", "ns": 1000000}]
})";

class Costs : public CommandLineTest {
protected:
    json run_comparison_with_costs(Words words) const {
        words.insert(words.begin(), "compare");
        for (const char* word :
             {"-o", "out", "--json", "--techniques", "naive:bounces=0,face=16", "raytrace:depth=1"})
            words.emplace_back(word);
        const test::ProcessResult ended = run_cli(add_small_frame_options(words));
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(ended.out);
    }
};

double find_work_count(const json& row, const char* kind) {
    return row["work"][kind].get<double>();
}

TEST_F(Costs, CountedWorkIsInAllFilesAndRepeats) {
    const json document = run_comparison_with_costs({"--work"});
    const json &naive = document["rows"][0], &traced = document["rows"][1];
    EXPECT_EQ(find_work_count(traced, "camera_rays"), 32 * 32);
    EXPECT_EQ(find_work_count(traced, "camera_rays"), traced["rays"]["primary"].get<double>());
    EXPECT_EQ(find_work_count(naive, "camera_rays"), 0);
    EXPECT_GT(find_work_count(naive, "vertices"), 100);
    EXPECT_EQ(find_work_count(naive, "frames"), 1);
    // The counts of all passes add up to the count of the row.
    for (const json& row : {naive, traced})
        for (const char* kind : {"fragments", "draws", "bytes", "passes"}) {
            double sum = 0;
            for (const json& pass : row["work_by_pass"]) sum += pass.value(kind, 0.0);
            EXPECT_EQ(sum, find_work_count(row, kind)) << kind;
        }
    EXPECT_THAT(read_output_file("out/report.md"), HasSubstr("Work of one frame"));
    EXPECT_THAT(read_output_file("out/report.html"), HasSubstr("Work of one frame"));
    const json again = run_comparison_with_costs({"--work"});
    for (int row : {0, 1}) {
        EXPECT_EQ(again["rows"][row]["work"], document["rows"][row]["work"]);
        EXPECT_EQ(again["rows"][row]["work_by_pass"], document["rows"][row]["work_by_pass"]);
    }
    EXPECT_FALSE(run_comparison_with_costs({})["rows"][0].contains("work"));
}

TEST_F(Costs, MapHasTheWorkOfAFrameAtRest) {
    const json document = run_comparison_with_costs({"--map"});
    const json &naive = document["rows"][0], &traced = document["rows"][1];
    const auto at_rest = [](const json& row, const char* kind) {
        return row["work_at_rest"][0].value(kind, 0.0);
    };
    EXPECT_EQ(naive["work_at_rest"].size(), 1u);
    // At rest, captures and shadow maps are kept: fewer passes and draws. Rays are traced again.
    EXPECT_LT(at_rest(naive, "passes"), find_work_count(naive, "passes"));
    EXPECT_LT(at_rest(naive, "draws"), find_work_count(naive, "draws"));
    EXPECT_GT(at_rest(naive, "fragments"), 0);
    EXPECT_EQ(at_rest(traced, "camera_rays"), find_work_count(traced, "camera_rays"));
    EXPECT_THAT(read_output_file("out/report.md"),
                AllOf(HasSubstr("Fastest row with FLIP of at most 0.05 by device"),
                      HasSubstr("| GeForce RTX 2080 Ti (literature)")));
    const std::string page = read_output_file("out/report.html");
    EXPECT_THAT(page, AllOf(HasSubstr("<div class=\"map\">"), HasSubstr("class TradeMap")));
    // The user's own costs come first, and a name of docs/costs is not listed twice.
    write_input_file("card.json", kDeviceCostsJson);
    run_comparison_with_costs({"--map", "--costs", "card.json", "--costs", "gtx-680"});
    const std::string own = read_output_file("out/report.md");
    const std::size_t mine = own.find("\n| card (given) "),
                      known = own.find("\n| GeForce GTX 680 (");
    EXPECT_LT(mine, known);
    EXPECT_EQ(own.find("\n| GeForce GTX 680 (", known + 1), std::string::npos);
    EXPECT_THAT(read_output_file("out/report.html"), HasSubstr("\"name\":\"card\""));
    EXPECT_FALSE(run_comparison_with_costs({"--work"})["rows"][0].contains("work_at_rest"));
    EXPECT_THAT(read_output_file("out/report.html"), testing::Not(HasSubstr("class TradeMap")));
}

TEST_F(Costs, TimeOnAnotherDeviceFollowsFromTheCounts) {
    write_input_file("card.json", kDeviceCostsJson);
    const json document = run_comparison_with_costs({"--costs", "card.json"});
    for (const json& row : document["rows"]) {
        const json& device = row["costs"][0];
        EXPECT_EQ(device["device"], "card (given)");
        const double rays = find_work_count(row, "camera_rays"),
                     other = find_work_count(row, "fragments") + 1e6;
        EXPECT_NEAR(device["ms"].get<double>(), 1e-6 * (100 * rays + other), 1e-9);
        EXPECT_NEAR(device["low_ms"].get<double>(), 1e-6 * (50 * rays + other), 1e-9);
        EXPECT_NEAR(device["high_ms"].get<double>(), 1e-6 * (200 * rays + other), 1e-9);
    }
    // The row with black mirrors is never on the front, so only the traced row is.
    EXPECT_EQ(document["rows"][0]["costs"][0]["on_front"], false);
    EXPECT_EQ(document["rows"][1]["costs"][0]["on_front"], true);
    EXPECT_THAT(
        read_output_file("out/report.md"),
        HasSubstr("Front on card (given): raytrace:depth=1 (0 of 1 not ray traced alone)."));
    // The page has the first sentences for both devices, and shows those of the device on which
    // times were measured.
    const std::string page = read_output_file("out/report.html");
    EXPECT_THAT(page, HasSubstr("<option value=\"1\">card (given), predicted from counted work<"));
    EXPECT_THAT(page, HasSubstr("<div data-device=\"1\" hidden><p class=\"lede\">On card (given), "
                                "by times predicted from counted work, "));
    EXPECT_THAT(page, HasSubstr("<div data-device=\"0\"><p class=\"lede\">On this device, "));
}

TEST_F(Costs, BudgetIsAnsweredForEachDevice) {
    write_input_file("card.json", kDeviceCostsJson);
    Words words{"compare", "-o", "out", "--costs", "card.json", "--max-ms", "1.15"};
    for (const char* word : {"--techniques", "reuse:face=16", "raytrace:depth=1", "raytrace"})
        words.emplace_back(word);
    run_cli(add_small_frame_options(words)); // the exit code depends on measured times
    // By the cost file, a frame takes 1 ms and its rays take .05 to .2 ms. The longest predicted
    // time exceeds the budget, so the answer is not certain.
    EXPECT_THAT(
        read_output_file("out/report.html"),
        HasSubstr(
            "<div data-device=\"1\" hidden><p class=\"lede answer\"><strong>"
            "Cannot tell whether a row keeps 1.15 ms on card (given). The interval of the "
            "time holds the limit, or is not known: raytrace:depth=1 (1.10 ms [1.05 - 1.21], "));
}

TEST_F(Costs, FileOfCostsIsRefusedBeforeAnyWork) {
    write_input_file("bad.json",
                     R"({"schema": "catoptric/costs/1", "device": "d", "origin": "given"})");
    write_input_file("card.json", kDeviceCostsJson);
    const Words compare{"compare", "-o", "out", "--costs"};
    const auto with = [&](Words more) {
        Words words = compare;
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    expect_usage_refused(with({"bad.json"}), 65,
                         {"bad.json: costs: wanted a list with at least one entry, found nothing"});
    expect_usage_refused(with({"none.json"}), 66, {"none.json: "});
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "report.json"));
}

TEST_F(Costs, BenchFitsTheTimesOfAnotherDevice) {
    write_input_file("times.json", R"({"schema": "catoptric/times/1", "device": "old card",
        "work": ["camera_rays", "frames"],
        "rows": [{"technique": "raytrace:depth=0", "ms": 12},
                 {"technique": "raytrace:depth=1", "ms": 12},
                 {"technique": "naive:bounces=0,face=16", "ms": 2}]})");
    const test::ProcessResult ended = run_cli({"bench", "--costs", "--times", "times.json",
                                               "--size", "32x32", "--json", "-o", "costs.json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json document = json::parse(ended.out);
    EXPECT_EQ(read_output_file("costs.json"), ended.out);
    EXPECT_EQ(document["device"], "old card");
    EXPECT_EQ(document["origin"], "fitted");
    // The given times are 12 ms for a frame with 1024 rays, and 2 ms for a frame without rays.
    EXPECT_EQ(document["costs"][0]["work"], "camera_rays");
    EXPECT_NEAR(document["costs"][0]["ns"].get<double>(), 10e6 / 1024, 1);
    EXPECT_NEAR(document["costs"][1]["ns"].get<double>(), 2e6, 200);
    EXPECT_EQ(document["fit"]["rows"], 3);
    // A comparison can predict times by the cost file that `bench` wrote.
    const json predicted = run_comparison_with_costs({"--costs", "costs.json"});
    EXPECT_NEAR(predicted["rows"][1]["costs"][0]["ms"].get<double>(), 12, .01);
}

TEST_F(Costs, BenchFitsThisDevice) {
    const test::ProcessResult ended = run_cli({"bench",
                                               "flat",
                                               "--costs",
                                               "--size",
                                               "16x16",
                                               "--frames",
                                               "2",
                                               "--warmup",
                                               "1",
                                               "--rounds",
                                               "2",
                                               "-o",
                                               "costs.json",
                                               "--techniques",
                                               "reuse",
                                               "naive:bounces=1",
                                               "parallax",
                                               "naive:bounces=0",
                                               "raytrace:depth=0",
                                               "raytrace:depth=1",
                                               "raytrace:depth=4"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::ContainsRegex("[0-9]+ rows, each predicted by costs that were "
                                                  "fitted to the others: [0-9]+ % within 20 %"));
    const json document = json::parse(read_output_file("costs.json"));
    EXPECT_GE(document["costs"].size(), 2u);
    for (const json& cost : document["costs"]) EXPECT_GT(cost["ns"].get<double>(), 0) << cost;
    for (const json& row : document["fit"]["left_out"])
        EXPECT_GT(row["measured_ms"].get<double>(), 0) << row;
}

TEST_F(Costs, BenchRefusesOptionsThatDoNotFit) {
    expect_usage_refused({"bench", "--times", "t.json"}, 2,
                         {"--times: wanted together with --costs, found it alone"});
    expect_usage_refused({"bench", "--costs", "--tune"}, 2,
                         {"--costs and --tune: wanted one of them, found both"});
    expect_usage_refused({"bench", "--costs", "--times", "none.json"}, 66, {"none.json: "});
    write_input_file("t.json", R"({"schema": "catoptric/times/1", "device": "d", "work": ["rays"],
                        "rows": [{"technique": "reuse", "ms": 1}]})");
    expect_usage_refused({"bench", "--costs", "--times", "t.json"}, 65,
                         {"t.json: work[0]: wanted a kind of work, found 'rays'"});
}

TEST_F(Costs, ShippedFilesAreReadAndNameASourceForEachCost) {
    std::size_t files = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(test::source_folder() / "docs" / "costs")) {
        if (entry.path().extension() != ".json" || entry.path().string().ends_with(".times.json"))
            continue;
        ++files;
        const json document = json::parse(read_file_at_path(entry.path()));
        EXPECT_EQ(document["schema"], "catoptric/costs/1") << entry.path();
        for (const json& cost : document["costs"])
            EXPECT_FALSE(cost.value("source", "").empty()) << entry.path() << cost;
    }
    EXPECT_GE(files, 3u);
}

} // namespace
