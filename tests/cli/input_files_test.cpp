// Tests that each option which names an input file is checked before the first frame: a broken file
// is refused without progress, without output, and with the place, the wanted and the found value.
#include "cli/program.hpp"
#include "measure/picture.hpp"

#include <limits>

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class InputFiles : public CommandLineTest {
protected:
    /// Runs a command whose output would be out, out.json or out.png, and expects a refusal before
    /// any frame.
    void expect_refused_before_frames(Words words, int exit_code, const Words& parts) const {
        words.insert(words.end(), {"--progress", "always"});
        const test::ProcessResult ended = run_cli(words);
        expect_exit_code(ended, exit_code, parts);
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        for (const char* output : {"out", "out.json", "out.png"})
            EXPECT_FALSE(std::filesystem::exists(folder / output)) << output;
    }
    /// Returns a comparison of 6 frames. `more` comes before the techniques.
    static Words compare_words(const Words& more) {
        Words words{"compare", "flat",     "--size", "32x32", "--frames",
                    "6",       "--warmup", "1",      "-o",    "out"};
        words.insert(words.end(), more.begin(), more.end());
        words.insert(words.end(), {"--techniques", "planar", "reuse:face=16"});
        return words;
    }
    void write_picture_of_row(const std::string& name, int width, int height, float value) const {
        measure::Picture picture(width, height);
        picture.at(3, 5).g = value;
        measure::write_exr(picture, folder / name);
    }
};

TEST_F(InputFiles, BaselineIsCheckedBeforeTheFirstFrame) {
    Words small = compare_words({});
    ASSERT_EQ(run_cli(small).exit_code, 0);
    json report = json::parse(read_output_file("out/report.json"));
    std::filesystem::remove_all(folder / "out");
    const auto expect = [&](const std::string& text, int exit_code, const Words& parts) {
        write_input_file("old.json", text);
        expect_refused_before_frames(compare_words({"--baseline", "old.json"}), exit_code, parts);
    };
    const json whole = report;
    report["size"] = {64, 64};
    expect(report.dump(), 65,
           {"old.json: wanted a baseline with the same size as now ([32,32]), found '[64,64]'"});
    report = whole, report["scene"]["hash"] = "feed";
    expect(report.dump(), 65, {"the same scene.hash as now"});
    report = whole, report["complete"] = false;
    expect(report.dump(), 65, {"wanted a complete report, found one that was stopped"});
    report = whole, report["rows"][1]["error"]["flip"] = "low";
    expect(report.dump(), 65,
           {"old.json: rows[1].error.flip: wanted a number or null, found '\"low\"'"});
    expect(R"({"schema": "catoptric/plan/1"})", 65,
           {"old.json: wanted a report.json of 'catoptric compare', found schema"});
    expect("{\"schema\": ", 65,
           {"old.json: JSON: line 1, column 12: wanted a value, found the end"});
    expect_refused_before_frames(compare_words({"--baseline", "none.json"}), 66, {"none.json"});
}

TEST_F(InputFiles, PicturesOfRowsAreReadBeforeTheFirstFrame) {
    write_picture_of_row("nan.exr", 32, 32, std::numeric_limits<float>::quiet_NaN());
    expect_refused_before_frames(
        compare_words({"--row", "mine=nan.exr"}), 65,
        {"nan.exr: pixel (3, 5): wanted three finite numbers, found 0 nan 0"});
    write_picture_of_row("inf.exr", 32, 32, std::numeric_limits<float>::infinity());
    expect_refused_before_frames(
        compare_words({"--row", "mine=inf.exr"}), 65,
        {"inf.exr: pixel (3, 5): wanted three finite numbers, found 0 inf"});
    write_picture_of_row("small.exr", 16, 16, 0);
    expect_refused_before_frames(compare_words({"--row", "mine=small.exr"}), 65,
                                 {"small.exr: wanted a picture of 32x32", "found 16x16"});
    write_picture_of_row("whole.exr", 32, 32, 1);
    const std::string whole = read_output_file("whole.exr");
    write_input_file("cut.exr", whole.substr(0, whole.size() - 40));
    expect_refused_before_frames(compare_words({"--row", "mine=cut.exr"}), 65, {"cut.exr"});
}

TEST_F(InputFiles, CostsTimesAndPlansAreReadBeforeTheFirstFrame) {
    write_input_file("broken.json", R"({"schema": "catoptric/costs/1", "device": 3})");
    write_picture_of_row("mine.exr", 32, 32, 1);
    expect_refused_before_frames(compare_words({"--costs", "broken.json"}), 65,
                                 {"broken.json", "wanted", "found"});
    expect_refused_before_frames(
        compare_words({"--row", "mine=mine.exr", "--row-times", "broken.json"}), 65,
        {"broken.json", "wanted", "found"});
    write_input_file("times.json", R"({"schema": "catoptric/row-times/1", "device": "card",
                                       "rows": [{"row": "other", "ms": 1}]})");
    expect_refused_before_frames(
        compare_words({"--row", "mine=mine.exr", "--row-times", "times.json"}), 2,
        {"wanted the name of a row of --row, found 'other'"});
    write_input_file("plan.json", R"({"plan": [{"mirror": 1, "technique": 3}]})");
    Words words = compare_words({});
    words.emplace_back("plan:plan.json");
    expect_refused_before_frames(words, 65, {"plan.json", "wanted", "found"});
    write_input_file("other.json", R"({"plan": [{"mirror": "nothing", "technique": "reuse"}]})");
    words.back() = "plan:other.json";
    expect_refused_before_frames(words, 2, {"nothing"});
}

TEST_F(InputFiles, StoredReferenceIsReadBeforeTheFirstFrame) {
    write_input_file("reference.exr", "no picture");
    expect_refused_before_frames({"compare", "cornell-rough", "--size", "32x32", "--frames", "6",
                                  "--reference", "reference.exr", "-o", "out", "--techniques",
                                  "reuse:face=16"},
                                 65, {"reference.exr"});
    expect_refused_before_frames(compare_words({"--reference", "new.exr"}), 2,
                                 {"--reference new.exr: wanted a reference with noise"});
}

TEST_F(InputFiles, FilesOfOtherVerbsAreReadBeforeTheFirstFrame) {
    write_input_file("plan.json", R"({"plan": [{"mirror": 1, "technique": 3}]})");
    write_input_file("costs.json", R"({"schema": "catoptric/costs/1", "device": 3})");
    const Words parts{".json", "wanted", "found"};
    expect_refused_before_frames({"render", "flat", "--plan", "plan.json", "-o", "out.png"}, 65,
                                 parts);
    expect_refused_before_frames({"choose", "flat", "--certify", "plan.json"}, 65, parts);
    expect_refused_before_frames({"choose", "flat", "--max-ms", "1", "--costs", "costs.json", "-o",
                                  "out.json", "--techniques", "planar"},
                                 65, parts);
    expect_refused_before_frames({"bench", "--costs", "--times", "costs.json", "-o", "out.json"},
                                 65, parts);
}

} // namespace
