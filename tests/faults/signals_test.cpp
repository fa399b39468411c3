// Tests of failure R7 of docs/extremes.md: signals during a run.
#include "faults/faults.hpp"

#include <array>
#include <random>

namespace {

namespace fs = std::filesystem;

class StopSignalTest : public CommandLineTest {};

constexpr double kMaxSecondsAfterSignal = 2; // seconds from the signal to the end

TEST_F(StopSignalTest, SignalEndsCompareSoonAndKeepsItsRows) {
    double longest = 0;
    const Words words{"compare", "-o",       "old", "--size",       "16x16",       "--frames",
                      "1",       "--warmup", "0",   "--techniques", "reuse:face=8"};
    ASSERT_EQ(run_cli(words).exit_code, 0);
    for (const auto& [signal, exit_code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}})
        for (const std::string at : {"[1/20]", "[3/20]"}) {
            fs::remove_all(folder / "out");
            fs::copy(folder / "old", folder / "out", fs::copy_options::recursive);
            test::ProcessStartOptions process = make_process_start(
                {"compare", "-o", "out", "--size", "32x32", "--frames", "5", "--warmup", "1",
                 "--progress", "always", "--techniques", "reuse:face=16", "raytrace:depth=1",
                 "parallax:face=16", "raytrace:depth=0"});
            process.signal = signal;
            process.signal_at = at;
            const test::ProcessResult ended = test::run_process(process);
            EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
            EXPECT_LE(ended.seconds_after_signal, kMaxSecondsAfterSignal) << at;
            longest = std::max(longest, ended.seconds_after_signal);
            const nlohmann::json document = nlohmann::json::parse(
                read_output_file("out/report.json"));
            if (document["complete"] == true) { // no row was finished, so the old report stays
                EXPECT_EQ(at, "[1/20]");
                EXPECT_EQ(read_output_file("out/report.json"), read_output_file("old/report.json"));
                EXPECT_THAT(ended.err, testing::HasSubstr("0 of 4 rows; nothing was written"));
                continue;
            }
            EXPECT_GE(document["rows"].size(), static_cast<std::size_t>(at[1] - '1')) << at;
            EXPECT_LT(document["rows"].size(), 4U) << at;
            for (const auto& row : document["rows"])
                EXPECT_TRUE(fs::exists(folder / "out/images" /
                                       fs::path(row["image"].get<std::string>()).filename()));
        }
    std::printf("  from the signal to the end: at most %.2f s\n", longest);
}

/// Fixture that sends a signal at a random time before the driver is open. With LD_DEBUG the
/// dynamic linker prints when it starts the program and which libraries are opened later.
class EarlySignalTest : public CommandLineTest {
protected:
    test::ProcessResult run_and_signal_before_driver(const Words& words, int signal,
                                                     const std::string& at, int milliseconds) {
        test::ProcessStartOptions process = make_process_start(words);
        process.environment = {{"LD_DEBUG", "files"}};
        process.signal = signal, process.signal_at = at;
        process.signal_after = std::chrono::milliseconds(milliseconds);
        return test::run_process(process);
    }
    static bool was_stopped_by_signal_with_message(const test::ProcessResult& ended, int signal) {
        return ended.exit_code == 128 + signal &&
               ended.err.find("catoptric: stopped by signal " + std::to_string(signal)) !=
                   std::string::npos;
    }
    static constexpr std::array kTestedSignals{SIGHUP, SIGINT, SIGTERM};
    const std::vector<Words> programs{
        {"render", "--technique", "raytrace:samples=64", "-o", "x.png"},
        {"compare", "-o", "out"},
        {"info"},
        {"list", "devices"},
        {"stress"},
        {"bench"}};
};

/// The function main opens the driver, and from then on the program answers each signal with a
/// message.
TEST_F(EarlySignalTest, SignalsAreAnsweredWhileTheDriverIsOpened) {
    std::mt19937 random(1);
    for (std::size_t i = 0; i < 2 * programs.size(); ++i) {
        const int signal = kTestedSignals[i % kTestedSignals.size()];
        const int after = static_cast<int>(random() % 6); // milliseconds
        const test::ProcessResult ended = run_and_signal_before_driver(programs[i / 2], signal,
                                                                       "libvulkan_lvp", after);
        EXPECT_TRUE(was_stopped_by_signal_with_message(ended, signal))
            << programs[i / 2].front() << " after " << after << ": " << ended.exit_code;
    }
}

/// The program answers signals from its first static initialiser on, before main begins. An earlier
/// signal ends the process without a message, because no code of the program has run yet.
TEST_F(EarlySignalTest, SignalsAreAnsweredFromTheFirstInitialiserOn) {
    std::mt19937 random(2);
    int answered = 0, wordless = 0;
    for (int i = 0; i < 30; ++i) {
        const int signal = kTestedSignals[static_cast<std::size_t>(i) % kTestedSignals.size()];
        const int after = static_cast<int>(random() % 12); // milliseconds
        const test::ProcessResult ended = run_and_signal_before_driver(
            programs[static_cast<std::size_t>(i) % programs.size()], signal, "transferring control",
            after);
        EXPECT_EQ(ended.exit_code, 128 + signal);
        ++(was_stopped_by_signal_with_message(ended, signal) ? answered : wordless);
    }
    std::printf("  answered %d of 30 signals, %d came before the program's first object\n",
                answered, wordless);
    EXPECT_GE(answered, 24); // the others came before the first initialiser
}

/// A frame is one submit, which cannot be stopped. Its picture is not written after the signal.
TEST_F(StopSignalTest, SignalInTheLastFrameWritesNoPicture) {
    test::ProcessStartOptions process = make_process_start(
        {"render", "--technique", "raytrace:samples=128", "--size", "256x256", "--frames", "1",
         "--warmup", "0", "--progress", "always", "-o", "x.png"});
    process.signal = SIGINT;
    process.signal_at = "[1/1]";
    process.signal_after = std::chrono::milliseconds(1000);
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 130) << ended.err;
    EXPECT_FALSE(fs::exists(folder / "x.png"));
}

} // namespace
