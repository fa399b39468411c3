// Tests of `catoptric stress`, which prints measured values beside their thresholds.
#include "cli/program.hpp"

namespace {

using nlohmann::json;

TEST_F(CommandLineTest, StressReportsMeasuredValuesAndThresholds) {
    const std::vector<std::string> ids{"N4", "N10", "C8"};
    Words words{"stress", "-o", "out", "--json", "--size", "64x64", "--only"};
    words.insert(words.end(), ids.begin(), ids.end());
    const test::ProcessResult ended = run_cli(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    const json document = json::parse(ended.out);
    EXPECT_EQ(document["schema"], "catoptric/stress/1");
    ASSERT_EQ(document["rows"].size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const json& row = document["rows"][i];
        EXPECT_EQ(row["id"], ids[i]);
        EXPECT_EQ(row["verdict"], "pass") << row;
        EXPECT_GT(row["cases"].size(), 1u);
        EXPECT_LE(row["measured"].get<double>(), row["threshold"].get<double>());
    }
    EXPECT_EQ(json::parse(read_output_file("out/stress.json")), document);
    EXPECT_THAT(read_output_file("out/stress.html"), testing::HasSubstr("N10"));
}

/// All rows of rough surfaces must also pass with another seed than the default.
TEST_F(CommandLineTest, StressMeasuresRoughSurfaces) {
    const std::vector<std::string> ids{"S1", "S2", "S3", "S4", "S5"};
    Words words{"stress", "--json", "--seed", "2", "--size", "32x32", "--only"};
    words.insert(words.end(), ids.begin(), ids.end());
    const test::ProcessResult ended = run_cli(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    const json document = json::parse(ended.out);
    ASSERT_EQ(document["rows"].size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
        EXPECT_EQ(document["rows"][i]["id"], ids[i]);
        EXPECT_EQ(document["rows"][i]["verdict"], "pass") << document["rows"][i];
    }
}

TEST_F(CommandLineTest, StressDrawsItsScenesFromTheSeed) {
    const auto measured = [&](const std::string& seed) {
        return json::parse(
            run_cli({"stress", "--json", "--size", "32x32", "--only", "C11", "--seed", seed})
                .out)["rows"][0]["cases"];
    };
    EXPECT_EQ(measured("3"), measured("3"));
    EXPECT_NE(measured("3"), measured("4"));
}

TEST_F(CommandLineTest, StressReportsQualityWarningsWithoutFailing) {
    const test::ProcessResult ended = run_cli({"stress", "--size", "32x32", "--only", "C5"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    EXPECT_THAT(ended.out, testing::HasSubstr("quality-warning"));
    expect_usage_refused({"stress", "--only", "N99"}, 2, {"N99", "did you mean"});
}

} // namespace
