// Tests of `compare --baseline`, the gate for pipelines.
#include "cli/program.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;

class BaselineGate : public CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        ASSERT_EQ(run_comparison_into_folder("old", {}).exit_code, 0);
        report_ = json::parse(read_file_at_path(folder / "old/report.json"));
    }
    test::ProcessResult run_comparison_into_folder(const std::string& output,
                                                   const Words& more) const {
        Words words{"compare", "flat", "--size", "32x32", "--warmup", "1", "-o", output};
        words.insert(words.end(), more.begin(), more.end());
        for (const char* word : {"--frames", "6", "--techniques", "reuse:face=16", "planar"})
            words.emplace_back(word);
        return run_cli(words);
    }

    json report_;
};

TEST_F(BaselineGate, SamePicturesPassAndMoreErrorFails) {
    const Words loose{"--baseline", "old/report.json", "--max-time-ratio", "1000"};
    const test::ProcessResult same = run_comparison_into_folder("new", loose);
    ASSERT_EQ(same.exit_code, 0) << same.err << same.out;
    EXPECT_THAT(same.out, HasSubstr("baseline: 0 worse, "));

    json& flip = report_["rows"][0]["error"]["flip"];
    flip = flip.get<double>() / 1.05; // the earlier picture erred less
    write_input_file("better.json", report_.dump());
    const test::ProcessResult worse = run_comparison_into_folder(
        "new", {"--baseline", "better.json", "--max-time-ratio", "1000", "--summary", "s.md",
                "--junit", "j.xml"});
    EXPECT_EQ(worse.exit_code, 1) << worse.err;
    EXPECT_THAT(worse.out, HasSubstr("worse: reuse:face=16, flip: FLIP "));
    EXPECT_THAT(worse.out, HasSubstr("baseline: 1 worse, "));
    EXPECT_THAT(read_output_file("s.md"), HasSubstr("### flat: worse than the baseline"));
    EXPECT_THAT(read_output_file("j.xml"), HasSubstr("<failure message=\"FLIP "));
    EXPECT_TRUE(std::filesystem::exists(folder / "new/report.html")); // the report of the new
                                                                      // comparison is kept
    EXPECT_EQ(run_comparison_into_folder("new", {"--baseline", "better.json", "--max-time-ratio",
                                                 "1000", "--max-flip-rise", "0.06"})
                  .exit_code,
              0);
}

TEST_F(BaselineGate, BaselineIsNeverOverwrittenAndMustFit) {
    const test::ProcessResult onto = run_comparison_into_folder("old",
                                                                {"--baseline", "old/report.json"});
    EXPECT_EQ(onto.exit_code, 2);
    EXPECT_THAT(onto.err, HasSubstr("old/report.json: cannot be written: it is the same file as "
                                    "old/report.json, which is the baseline"));
    EXPECT_EQ(json::parse(read_file_at_path(folder / "old/report.json")), report_);
    EXPECT_EQ(run_comparison_into_folder("new", {"--baseline", "none.json"}).exit_code, 66);
    write_input_file("broken.json", "{\"schema\": ");
    EXPECT_EQ(run_comparison_into_folder("new", {"--baseline", "broken.json"}).exit_code, 65);
    const test::ProcessResult alone = run_comparison_into_folder("new", {"--junit", "j.xml"});
    EXPECT_EQ(alone.exit_code, 2);
    EXPECT_THAT(alone.err, HasSubstr("wanted --baseline beside them"));
    const test::ProcessResult other = run_comparison_into_folder(
        "new", {"--baseline", "old/report.json", "--time", "1"});
    EXPECT_EQ(other.exit_code, 65);
    EXPECT_THAT(other.err,
                HasSubstr("old/report.json: wanted a baseline with the same time as now"));
}

} // namespace
