// Tests of `compare --axis`: each technique that has the knob becomes a row for each value.
#include "cli/program.hpp"

#include <nlohmann/json.hpp>

namespace {

TEST_F(CommandLineTest, AxisMakesARowForEachValue) {
    const auto run = run_cli({"compare", "-o", "out", "--size", "24x16", "--frames", "6",
                              "--warmup", "1", "--quiet", "--axis", "bounces=1,2,3", "--axis",
                              "face=16,32", "--techniques", "naive", "reuse:face=8",
                              "raytrace:depth=2"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json report = nlohmann::json::parse(read_output_file("out/report.json"));
    std::vector<std::string> labels;
    for (const nlohmann::json& row : report["rows"]) labels.push_back(row["label"]);
    EXPECT_THAT(labels, testing::ElementsAre("naive:bounces=1,face=16", "naive:bounces=1,face=32",
                                             "naive:bounces=2,face=16", "naive:bounces=2,face=32",
                                             "naive:bounces=3,face=16", "naive:bounces=3,face=32",
                                             "reuse:face=8", "raytrace:depth=2"))
        << "rows that set the knob, or lack it, stay as they are";
    EXPECT_THAT(read_output_file("out/report.html"), testing::HasSubstr("class=\"curve\""));
}

TEST_F(CommandLineTest, AxisLeavesOutRowsThatAreThere) {
    const auto run = run_cli({"compare", "-o", "out", "--size", "24x16", "--frames", "6",
                              "--warmup", "1", "--quiet", "--axis", "bounces=1,01,2,3",
                              "--techniques", "naive", "naive:bounces=2"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json report = nlohmann::json::parse(read_output_file("out/report.json"));
    std::vector<std::string> labels;
    for (const nlohmann::json& row : report["rows"]) labels.push_back(row["label"]);
    EXPECT_THAT(labels, testing::UnorderedElementsAre("naive:bounces=1", "naive:bounces=2",
                                                      "naive:bounces=3"));
}

TEST_F(CommandLineTest, AxisWithoutEffectIsNoted) {
    const auto run = run_cli({"compare", "cornell-mirrors", "-o", "out", "--size", "24x16",
                              "--frames", "6", "--warmup", "1", "--axis", "taps=8,16",
                              "--techniques", "planar", "naive"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, testing::HasSubstr("--axis taps: the picture of planar:taps=8 is the same "
                                            "with each value; the knob may have no effect"));
    const auto other = run_cli({"compare", "cornell-mirrors", "-o", "out", "--size", "24x16",
                                "--frames", "6", "--warmup", "1", "--axis", "face=8,64",
                                "--techniques", "reuse"});
    ASSERT_EQ(other.exit_code, 0) << other.err;
    EXPECT_THAT(other.err, testing::Not(testing::HasSubstr("--axis")));
}

TEST_F(CommandLineTest, AxisErrorsSayWhatIsWanted) {
    for (const char* text : {"rays", "rays=", "=1,2", "rays=4", "rays=1,1", "rays=1,,2"})
        expect_usage_refused({"compare", "-o", "x", "--axis", text, "--techniques", "raytrace"}, 2,
                             {"--axis: wanted KNOB=VALUE,VALUE,... with different values"});
    expect_usage_refused(
        {"compare", "-o", "x", "--axis", "bounces=1,2", "--techniques", "raytrace"}, 2,
        {"--axis bounces: wanted a knob of one of the techniques"});
    expect_usage_refused(
        {"compare", "-o", "x", "--axis", "bounces=1,many", "--techniques", "naive"}, 2,
        {"bounces", "many"});
}

} // namespace
