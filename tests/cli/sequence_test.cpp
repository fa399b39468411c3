// Tests of sequences with a picture per frame, of progress messages without a terminal, of rounds,
// and of the columns of rows.csv.
#include "catoptric/file_sequence.hpp"
#include "cli/program.hpp"
#include "report/writer.hpp"
#include "support/refusal.hpp"

#include <set>
#include <sstream>

namespace {

using catoptric::Failure;
using catoptric::cli::FileSequence;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;

TEST(SequenceName, FrameNumberReplacesThePlaceholder) {
    EXPECT_EQ(FileSequence::parse("a{n}.png")->file(7), "a7.png");
    EXPECT_EQ(FileSequence::parse("a{n:3}.png")->file(7), "a007.png");
    EXPECT_EQ(FileSequence::parse("a{n:04}.exr")->file(12345), "a12345.exr");
    EXPECT_EQ(FileSequence::parse("d/%d.png")->file(10), "d/10.png");
    EXPECT_EQ(FileSequence::parse("%04d.png")->file(10), "0010.png");
    EXPECT_FALSE(FileSequence::parse("100%.png"));
    EXPECT_FALSE(FileSequence::parse("50%done/x.exr"));
    EXPECT_FALSE(FileSequence::parse("{n}/{n:x}/x.exr"));
    EXPECT_EQ(FileSequence::parse("50%done/x%d.exr")->file(2), "50%done/x2.exr");
    EXPECT_FALSE(FileSequence::parse("{a}.png"));
}

TEST_F(CommandLineTest, InvalidSequenceNameIsRefused) {
    for (const std::string name : {"{n}{n}.png", "%d{n:2}.png", "{n:x}.png", "{n.png"})
        expect_usage_refused({"render", "--technique", "reuse", "--frames", "2", "-o", name}, 2,
                             {"-o", name});
    expect_usage_refused({"render", "--technique", "reuse", "-o", "{n}.png"}, 2,
                         {"--frames, --animate or --camera-path", "{n}.png"});
}

TEST_F(CommandLineTest, RenderOfASequenceWritesOnePicturePerFrame) {
    const test::ProcessResult ended = run_cli({"render", "--technique", "reuse:face=16",
                                               "--animate", "--frames", "3", "--warmup", "2",
                                               "--size", "32x32", "-o", "s_{n:3}.png"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    std::set<std::string> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        files.insert(entry.path().filename().string());
    EXPECT_EQ(files, (std::set<std::string>{"s_001.png", "s_002.png", "s_003.png"}));
    // The last picture of the sequence equals the picture that the same command writes without a
    // sequence.
    ASSERT_EQ(run_cli({"render", "--technique", "reuse:face=16", "--animate", "--frames", "3",
                       "--warmup", "2", "--size", "32x32", "-o", "last.png"})
                  .exit_code,
              0);
    EXPECT_EQ(read_output_file("s_003.png"), read_output_file("last.png"));
    // Picture N of a sequence equals the picture of a run of N frames.
    ASSERT_EQ(run_cli({"render", "--technique", "reuse:face=16", "--animate", "--frames", "1",
                       "--warmup", "2", "--size", "32x32", "-o", "first.png"})
                  .exit_code,
              0);
    EXPECT_EQ(read_output_file("s_001.png"), read_output_file("first.png"));
}

TEST_F(CommandLineTest, SequenceThatWouldOverwriteASceneFileIsRefused) {
    write_input_file("2.png", "mine");
    write_input_file("t.obj", "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    write_input_file("t.mtl", "newmtl m\nmap_Kd 2.png\n");
    const test::ProcessResult ended = run_cli(
        {"render", "t.obj", "--technique", "reuse", "--frames", "3", "-o", "%d.png"});
    EXPECT_NE(ended.exit_code, 0);
    EXPECT_EQ(read_output_file("2.png"), "mine");
}

TEST_F(CommandLineTest, MoreRoundsThanFramesAreRefused) {
    expect_usage_refused({"compare", "-o", "out", "--rounds", "30", "--frames", "20"}, 2,
                         {"--rounds", "at most 20", "found 30"});
    expect_usage_refused({"compare", "-o", "out", "--rounds", "21"}, 2, {"--rounds", "at most 20"});
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(CommandLineTest, CompareReportsTenthsOfProgressIfStderrIsNoTerminal) {
    const Words words = add_small_frame_options({"compare", "-o", "out", "--techniques",
                                                 "naive:bounces=0", "reuse:face=16",
                                                 "parallax:face=16"});
    const test::ProcessResult ended = run_cli(words);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const char* part : {"30 % done", "60 % done", "left"})
        EXPECT_THAT(ended.err, HasSubstr(part));
    for (const Words& silent : {Words{"--quiet"}, Words{"--progress", "never"}}) {
        Words asked = words;
        asked.insert(asked.end(), silent.begin(), silent.end());
        EXPECT_THAT(run_cli(asked).err, Not(HasSubstr("% done")));
    }
}

/// Returns the cells of the second line of a CSV text, by the names in its first line. Cells of
/// this test hold no quotes.
std::map<std::string, std::string> first_csv_row_by_column(const std::string& csv) {
    std::istringstream lines(csv);
    std::string header, row;
    std::getline(lines, header);
    std::getline(lines, row);
    std::map<std::string, std::string> cells;
    std::istringstream names(header), fields(row);
    for (std::string name, field; std::getline(names, name, ',');) {
        std::getline(fields, field, ',');
        cells[name] = field;
    }
    return cells;
}

TEST_F(CommandLineTest, CsvHasTheColumnsOfTheTableOrAllIfAsked) {
    const Words words = add_small_frame_options(
        {"compare", "-o", "out", "--techniques", "reuse:face=16"});
    ASSERT_EQ(run_cli(words).exit_code, 0);
    const auto few = first_csv_row_by_column(read_output_file("out/rows.csv"));
    for (const char* name : {"label", "scene", "device", "date", "place_first", "gpu_ms_median",
                             "gpu_ms_ci95_low", "mirrors_flip", "mirrors_rmse"})
        EXPECT_TRUE(few.contains(name)) << name;
    for (const char* name : {"gpu_ms_samples", "mirror_1_flip", "all_psnr", "scene_hash"})
        EXPECT_FALSE(few.contains(name)) << name;
    EXPECT_LT(few.size(), 60U);

    Words all = words;
    all.insert(all.end(), {"--csv", "all"});
    ASSERT_EQ(run_cli(all).exit_code, 0);
    const auto every = first_csv_row_by_column(read_output_file("out/rows.csv"));
    for (const auto& [name, cell] : few) EXPECT_TRUE(every.contains(name)) << name;
    for (const char* name : {"gpu_ms_samples", "mirror_1_flip", "all_psnr", "scene_hash"})
        EXPECT_TRUE(every.contains(name)) << name;
    expect_usage_refused({"compare", "-o", "out", "--csv", "tabel"}, 2,
                         {"--csv", "did you mean 'table'"});
}

TEST_F(CommandLineTest, ReportHasTheDateOfTheRun) {
    ASSERT_EQ(run_cli(add_small_frame_options(
                          {"compare", "-o", "out", "--techniques", "naive:bounces=0"}))
                  .exit_code,
              0);
    const std::string date = nlohmann::json::parse(read_output_file("out/report.json"))["date"];
    EXPECT_THAT(date, testing::MatchesRegex("20[0-9][0-9]-[01][0-9]-[0-3][0-9]T[0-9:]{8}Z"));
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    ::gmtime_r(&now, &utc);
    EXPECT_EQ(std::stoi(date.substr(0, 4)), utc.tm_year + 1900);
    EXPECT_THAT(read_output_file("out/report.md"), HasSubstr(date));
}

} // namespace
