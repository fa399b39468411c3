// Tests of what the command line says of light that a row and its reference compute by different
// models: the knobs `indirect` and `ao`, and the option --environment-shadows.
#include "cli/program.hpp"

#include <nlohmann/json.hpp>

namespace {

TEST_F(CommandLineTest, RowsWithLightProbesSayWhichReferenceHasTheirLight) {
    for (const char* truth : {"centre", "paths"}) {
        const auto run = run_cli({"compare", "cornell-mirrors-closed", "-o", "out", "--size",
                                  "24x16", "--frames", "6", "--warmup", "1", "--truth", truth,
                                  "--reference-seconds", "1", "--quiet", "--techniques",
                                  "reuse:face=16",
                                  "reuse:face=16,indirect=captures,probes=27,ao=screen"});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const nlohmann::json report = nlohmann::json::parse(read_output_file("out/report.json"));
        std::string warnings;
        for (const std::string text : report["warnings"]) warnings += text;
        if (std::string_view(truth) == "centre")
            EXPECT_THAT(warnings,
                        testing::HasSubstr(
                            "'reuse:face=16,indirect=captures,probes=27,ao=screen': its light "
                            "between surfaces counts as an error beside this reference; --truth "
                            "paths has that light"));
        else
            EXPECT_THAT(warnings, testing::Not(testing::HasSubstr("light between surfaces")));
        EXPECT_THAT(warnings, testing::Not(testing::HasSubstr("'reuse:face=16': its light")));
        EXPECT_THAT(warnings, testing::Not(testing::HasSubstr("its shadow of the environment")));
        EXPECT_NE(report["rows"][0]["error_all"]["mae"], report["rows"][1]["error_all"]["mae"]);
    }
}

TEST_F(CommandLineTest, RasterisedRowsBesideShadowsOfTheEnvironmentGetAWarning) {
    const auto run = run_cli({"compare",
                              "cornell-mirrors",
                              "--environment",
                              "studio",
                              "-o",
                              "out",
                              "--size",
                              "16x12",
                              "--frames",
                              "6",
                              "--warmup",
                              "1",
                              "--environment-shadows",
                              "2",
                              "--reference-seconds",
                              "1",
                              "--quiet",
                              "--techniques",
                              "reuse:face=16",
                              "reuse:face=16,ao=screen",
                              "raytrace:depth=2"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json report = nlohmann::json::parse(read_output_file("out/report.json"));
    std::vector<std::string> found;
    for (const std::string text : report["warnings"])
        if (text.find("beside") != std::string::npos) found.push_back(text);
    EXPECT_THAT(found, testing::ElementsAre(testing::HasSubstr(
                           "'reuse:face=16': no surface hides the environment in its rasterised "
                           "pixels, which counts as an error beside --environment-shadows")));
}

TEST_F(CommandLineTest, ShadowsOfNoEnvironmentGetANote) {
    const auto run = run_cli({"render", "cornell-mirrors", "--size", "16x16", "--frames", "1",
                              "--warmup", "0", "--technique", "reuse:face=16",
                              "--environment-shadows", "2", "-o", "x.png"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, testing::HasSubstr("--environment-shadows has no effect: the scene has no "
                                            "environment (--environment adds one)"));
}

TEST_F(CommandLineTest, MoreLightProbesThanADeviceHoldsAreReported) {
    const auto run = run_cli({"render", "cornell-mirrors", "--size", "16x16", "--frames", "1",
                              "--warmup", "0", "--technique",
                              "reuse:face=16,indirect=captures,probes=4096", "-o", "x.png"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, testing::HasSubstr("of 4096 light probes, at most "));
    for (const char* row : {"reuse:indirect=captures", "*=reuse:indirect=captures"})
        expect_usage_refused(
            {"compare", "cornell-mirrors", "-o", "out", "--causes", "--techniques", row}, 2,
            {"--causes: wanted rows without light probes"});
}

} // namespace
