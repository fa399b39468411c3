// Tests of exit codes: 73 if an output cannot be created, 74 if writing breaks off, 130 or 143
// after a signal. The old file stays in each case.
#include "cli/program.hpp"

#include <cstring>

#include <sys/mount.h>

namespace {

namespace fs = std::filesystem;

TEST_F(CommandLineTest, OutputFileInAMissingFolderIsRefused) {
    expect_usage_refused({"render", "--technique", "reuse", "-o", "none/x.png"}, 73,
                         {"none/x.png", "no folder none"});
    expect_usage_refused(
        {"render", "--technique", "reuse", "-o", "x.png", "--trace", "none/t.json"}, 73,
        {"none/t.json"});
    expect_usage_refused(
        {"render", "--technique", "reuse", "-o", "x.png", "--profile", "none/p.json"}, 73,
        {"none/p.json"});
    EXPECT_FALSE(fs::exists(folder / "none"));
}

/// `-o DIR` creates the output folder and its parents, also for paths with `..` or a trailing
/// slash.
TEST_F(CommandLineTest, OutputFolderIsMadeWithItsParents) {
    for (const std::string name : {"./a/../b/out/", "b/out/again"}) {
        const test::ProcessResult ended = run_cli(
            add_small_frame_options({"compare", "--techniques", "raytrace:depth=1", "-o", name}));
        EXPECT_EQ(ended.exit_code, 0) << name << ": " << ended.err;
        EXPECT_TRUE(fs::exists(folder / name / "images/raytrace-depth1.png")) << name;
        EXPECT_TRUE(fs::exists(folder / name / "report.json")) << name;
    }
    const test::ProcessResult ended = run_cli(
        {"stress", "--size", "16x16", "--only", "N10", "-o", "c/d"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_TRUE(fs::exists(folder / "c/d/stress.json"));
}

TEST_F(CommandLineTest, ImpossibleOutputFolderIsRefusedBeforeAnyWork) {
    write_input_file("file", "old");
    fs::create_symlink("nowhere", folder / "dangling");
    for (const Words& verb : {Words{"compare"}, Words{"stress"}}) {
        const auto into = [&](const std::string& name) {
            Words words = verb;
            words.insert(words.end(), {"-o", name});
            return words;
        };
        expect_usage_refused(into("file/a/out"), 73, {"file/a/out", "wanted file to be a folder"});
        expect_usage_refused(into("dangling/out"), 73, {"dangling/out", "dangling to be a folder"});
        expect_usage_refused(into("/proc/a/out"), 73, {"/proc/a/out"});
    }
    EXPECT_EQ(read_output_file("file"), "old");
    EXPECT_FALSE(fs::exists(folder / "nowhere"));
}

TEST_F(CommandLineTest, OutputPathOfTheWrongKindIsRefused) {
    expect_usage_refused({"render", "--technique", "reuse", "-o", folder.string()}, 73,
                         {folder.string(), "found a folder"});
    fs::create_directory(folder / "x.png");
    expect_usage_refused({"render", "--technique", "reuse", "-o", "x.png"}, 73,
                         {"x.png", "found a folder"});
    expect_usage_refused({"render", "--technique", "reuse", "-o", "y.png/"}, 73, {"y.png/"});
    write_input_file("file", "old");
    expect_usage_refused({"compare", "-o", "file"}, 73, {"file", "wanted a folder"});
    EXPECT_EQ(read_output_file("file"), "old");
}

TEST_F(CommandLineTest, WritingToAFullDeviceExitsWith74) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full";
    fs::create_symlink("/dev/full", folder / "full.png");
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"render", "--technique", "reuse", "-o", "full.png", "--quiet"}));
    expect_exit_code(ended, 74, {"full.png"});

    test::ProcessStartOptions process = make_process_start({"list", "techniques"});
    process.out_path = "/dev/full";
    expect_exit_code(test::run_process(process), 74, {"stdout"});
}

TEST_F(CommandLineTest, FullDiskLeavesTheOldFile) {
    const fs::path disk = folder / "disk";
    fs::create_directory(disk);
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0)
        GTEST_SKIP() << "cannot mount a small tmpfs: " << std::strerror(errno);
    write_input_file("disk/x.exr", "old");
    const test::ProcessResult ended = run_cli({"render", "--technique", "reuse", "-o", "disk/x.exr",
                                               "--size", "256x256", "--frames", "1", "--warmup",
                                               "0", "--quiet"});
    const std::string old = read_output_file("disk/x.exr");
    const auto entries = std::distance(fs::directory_iterator(disk), fs::directory_iterator());
    ::umount(disk.c_str());
    expect_exit_code(ended, 74, {"disk/x.exr"});
    EXPECT_EQ(old, "old");
    EXPECT_EQ(entries, 1) << "a temporary was left behind";
}

TEST_F(CommandLineTest, ClosedPipeOnStdoutExitsWith74) {
    for (const Words& words : {Words{"list", "techniques"}, Words{"info", "--json"}}) {
        test::ProcessStartOptions process = make_process_start(words);
        process.no_reader = true;
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 74);
        EXPECT_EQ(ended.err, "");
    }
}

TEST_F(CommandLineTest, RenderWritesAPngToStdout) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"render", "--technique", "reuse", "-o", "-"}));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, testing::StartsWith("\x89PNG\r\n"));
    EXPECT_EQ(run_cli(add_small_frame_options({"render", "--technique", "reuse", "-o", "x.png"}))
                  .exit_code,
              0);
    EXPECT_EQ(read_output_file("x.png"), ended.out);
}

/// Returns the command line of a comparison of eight rows in five rounds.
std::vector<std::string> make_eight_row_command() {
    std::vector<std::string> words{"compare",
                                   "-o",
                                   "out",
                                   "--size",
                                   "32x32",
                                   "--frames",
                                   "5",
                                   "--warmup",
                                   "1",
                                   "--progress",
                                   "always",
                                   "--techniques",
                                   "reuse:face=64",
                                   "parallax:face=64"};
    for (int i = 1; i <= 6; ++i) words.push_back("naive:face=64,bounces=" + std::to_string(i));
    return words;
}

TEST_F(CommandLineTest, InterruptedCompareKeepsItsFinishedRows) {
    test::ProcessStartOptions process = make_process_start(make_eight_row_command());
    process.signal = SIGINT;
    process.signal_at = "[2/40] parallax:face=64, round 1 of 5";
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 130) << ended.err;
    EXPECT_THAT(ended.err, testing::HasSubstr("of 8 rows"));
    const nlohmann::json document = nlohmann::json::parse(read_output_file("out/report.json"));
    EXPECT_EQ(document["complete"], false);
    EXPECT_GE(document["rows"].size(), 1U);
    EXPECT_LT(document["rows"].size(), 8U);
    EXPECT_TRUE(fs::exists(folder / "out/report.html"));
}

TEST_F(CommandLineTest, CompareInterruptedInALaterRoundKeepsFinishedRounds) {
    test::ProcessStartOptions process = make_process_start(make_eight_row_command());
    process.signal = SIGINT;
    process.signal_at = "reuse:face=64, round 4 of 5";
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 130) << ended.err;
    const nlohmann::json document = nlohmann::json::parse(read_output_file("out/report.json"));
    ASSERT_EQ(document["rows"].size(), 8U);
    EXPECT_THAT(document["incomplete"], testing::MatchesRegex("8 of 8 rows: .*; [34] of 5 rounds"));
    for (const nlohmann::json& row : document["rows"]) {
        EXPECT_GE(row["gpu_ms"]["rounds"].size(), 3U);
        EXPECT_TRUE(row["error"]["rmse"].is_number());
    }
}

TEST_F(CommandLineTest, CompareInterruptedBeforeTheFirstRowWritesNothing) {
    test::ProcessStartOptions process = make_process_start(
        {"compare", "-o", "out", "--size", "32x32", "--frames", "1000", "--warmup", "1",
         "--progress", "always", "--techniques", "reuse"});
    process.signal = SIGTERM;
    process.signal_at = "reference";
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 143) << ended.err;
    EXPECT_THAT(ended.err, testing::HasSubstr("after 0 of 1 rows; nothing was written"));
    EXPECT_FALSE(std::filesystem::exists(folder / "out/report.json"));
}

TEST_F(CommandLineTest, CompareInterruptedDuringLagKeepsItsRows) {
    test::ProcessStartOptions process = make_process_start(
        {"compare", "-o", "out", "--lag", "--size", "32x32", "--frames", "1", "--warmup", "1",
         "--progress", "always", "--techniques", "raytrace", "reuse:face=16"});
    process.signal = SIGINT;
    process.signal_at = "lag of reuse";
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 130) << ended.err;
    EXPECT_THAT(ended.err,
                testing::HasSubstr("2 of 2 rows; their lag was not measured to its end"));
    const nlohmann::json document = nlohmann::json::parse(read_output_file("out/report.json"));
    EXPECT_EQ(document["complete"], false);
    EXPECT_EQ(document["rows"].size(), 2U);
    EXPECT_EQ(document["lag"]["complete"], false);
    EXPECT_EQ(document["lag"]["without_history"], nlohmann::json::array({"raytrace"}));
}

TEST_F(CommandLineTest, InterruptedRenderKeepsTheOldPicture) {
    write_input_file("x.png", "old");
    test::ProcessStartOptions process = make_process_start(
        {"render", "-o", "x.png", "--size", "32x32", "--frames", "100000", "--technique", "reuse",
         "--progress", "always"});
    process.signal = SIGINT;
    process.signal_at = "reuse";
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 130) << ended.err;
    EXPECT_EQ(read_output_file("x.png"), "old");
}

} // namespace
