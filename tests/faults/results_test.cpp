// Tests of failure R8 of docs/extremes.md: results survive. If a comparison or a stress run ends
// early, its finished rows are on disk. Every file is marked incomplete, with the reason and the
// number of finished rows.
#include "faults/faults.hpp"

#include <vulkan/vulkan_core.h>

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using testing::HasSubstr;

/// Returns how often `part` occurs in `text`.
std::size_t count_occurrences(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++count;
    return count;
}

class Results : public Faults {
protected:
    /// Returns the command line of a comparison of `rows` rows. The fifth row traces `samples`
    /// samples per pixel, which sets how long the row takes. With a reference of several samples,
    /// the last row is the last frame: no frame measures how far pixel centres are from pixels.
    static Words make_comparison_of_rows(int rows, int samples = 2) {
        Words words{"compare", "-o",       "out", "--size",     "64x64",  "--frames",
                    "1",       "--warmup", "0",   "--progress", "always", "--reference"};
        words.insert(words.end(), {"raytrace:depth=16,samples=2", "--techniques"});
        for (int i = 0; i < rows; ++i)
            words.push_back("raytrace:depth=" + std::to_string(i) +
                            (i == 4 ? ",samples=" + std::to_string(samples) : ""));
        return words;
    }

    /// Returns the text of a file without the backslashes that escape Markdown.
    std::string read_without_escapes(const std::string& file) const {
        std::string text = read_output_file(file);
        std::erase(text, '\\');
        return text;
    }

    /// Expects four of eight rows in out/. Every file must state this number and the reason `why`.
    void expect_four_rows(const std::string& why) const {
        const nlohmann::json document = nlohmann::json::parse(read_output_file("out/report.json"));
        EXPECT_EQ(document["complete"], false);
        EXPECT_EQ(document["rows_asked"], 8);
        EXPECT_THAT(document["incomplete"].get<std::string>(),
                    testing::StartsWith("4 of 8 rows: "));
        EXPECT_THAT(document["incomplete"].get<std::string>(), HasSubstr(why));
        ASSERT_EQ(document["rows"].size(), 4U);
        for (int i = 0; i < 4; ++i)
            EXPECT_EQ(document["rows"][i]["label"], "raytrace:depth=" + std::to_string(i));
        for (const char* file : {"out/report.html", "out/report.md", "out/rows.csv"}) {
            EXPECT_THAT(read_without_escapes(file), HasSubstr("4 of 8 rows: ")) << file;
            EXPECT_THAT(read_without_escapes(file), HasSubstr(why)) << file;
        }
        EXPECT_EQ(count_occurrences(read_output_file("out/report.html"), "<article id=\"row-"), 4U);
        EXPECT_EQ(count_occurrences(read_output_file("out/rows.csv"), "\r\n"), 5U);
        const auto pictures = fs::directory_iterator(folder / "out/images");
        EXPECT_EQ(std::distance(begin(pictures), end(pictures)), 3 + 4 * 5);
    }

    /// Sends a signal during the frame of the fifth row, and the same signal again after
    /// `again_after`.
    test::ProcessResult run_and_signal_in_fifth_row(int signal, int samples,
                                                    std::chrono::milliseconds after,
                                                    std::chrono::milliseconds again_after) const {
        test::ProcessStartOptions process = make_process_start(make_comparison_of_rows(8, samples));
        process.environment["LP_NUM_THREADS"] = "1";
        process.signal = signal;
        process.signal_at = "[5/8]";
        process.signal_after = after;
        process.again_after = again_after;
        return test::run_process(process);
    }
};

TEST_F(Results, FailureInTheFifthRowKeepsFourFinishedRows) {
    const WatchedRun four = run_with_fault_layer(make_comparison_of_rows(4), std::nullopt);
    ASSERT_EQ(four.ended.exit_code, 0) << four.ended.err;
    for (const auto& [call, result, exit_code, why] :
         {std::tuple{"vkWaitSemaphores", VK_ERROR_DEVICE_LOST, 76, "VK_ERROR_DEVICE_LOST"},
          std::tuple{"vkQueueWaitIdle", VK_ERROR_OUT_OF_HOST_MEMORY, 75,
                     "VK_ERROR_OUT_OF_HOST_MEMORY"},
          std::tuple{"vkAllocateMemory", VK_ERROR_OUT_OF_DEVICE_MEMORY, 75,
                     "VK_ERROR_OUT_OF_DEVICE_MEMORY"}}) {
        fs::remove_all(folder / "out");
        const WatchedRun watched = run_with_fault_layer(
            make_comparison_of_rows(8),
            VulkanCallFault{call, four.counts.at(call).calls + 1, result});
        EXPECT_EQ(watched.ended.exit_code, exit_code) << watched.ended.err;
        for (const std::string part :
             {why, ", after 4 of 8 rows; what there is lies in out, marked incomplete\n"})
            EXPECT_THAT(watched.ended.err, HasSubstr(part));
        EXPECT_THAT(watched.ended.out, HasSubstr("raytrace:depth=3")) << "the table so far";
        expect_four_rows(why);
    }
}

/// The command `timeout` sends SIGTERM to its child and then to the process group, so the child
/// gets the signal twice. A closed terminal sends SIGHUP.
TEST_F(Results, SignalSentTwiceKeepsFinishedRows) {
    for (const auto& [signal, exit_code] : {std::pair{SIGTERM, 143}, std::pair{SIGHUP, 129}}) {
        fs::remove_all(folder / "out");
        const test::ProcessResult ended = run_and_signal_in_fifth_row(signal, 400, 300ms, 50ms);
        EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
        const std::string why = "stopped by signal " + std::to_string(signal);
        EXPECT_THAT(ended.err, HasSubstr(why + ", after 4 of 8 rows; what there is lies in out"));
        expect_four_rows(why);
    }
}

/// The frame of the fifth row would take minutes. It runs in pieces, and the signal is seen between
/// two of them.
TEST_F(Results, SignalEndsAFrameOfMinutesAndKeepsFinishedRows) {
    const test::ProcessResult ended = run_and_signal_in_fifth_row(SIGTERM, 65536, 2000ms, 50ms);
    EXPECT_EQ(ended.exit_code, 143);
    const std::string why = "stopped by signal " + std::to_string(SIGTERM);
    EXPECT_THAT(ended.err, HasSubstr(why + ", after 4 of 8 rows; what there is lies in out"));
    expect_four_rows(why);
}

TEST_F(Results, IgnoredSignalStaysIgnored) {
    test::ProcessStartOptions process = make_process_start(make_comparison_of_rows(2));
    process.command.insert(process.command.begin(),
                           {"/bin/sh", "-c", "trap '' HUP; exec \"$0\" \"$@\""});
    process.signal = SIGHUP;
    process.signal_at = "[1/2]";
    const test::ProcessResult ended = test::run_process(process);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(nlohmann::json::parse(read_output_file("out/report.json"))["complete"], true);
}

TEST_F(Results, InterruptedStressKeepsItsFinishedRows) {
    const auto words = [](Words ids) {
        Words all{"stress", "-o", "out", "--size", "16x16", "--progress", "always", "--only"};
        all.insert(all.end(), ids.begin(), ids.end());
        return all;
    };
    const auto expect_one_row = [&](const test::ProcessResult& ended, int exit_code,
                                    const std::string& why) {
        EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(", after 1 of 3 rows; what there is lies in out"));
        const nlohmann::json document = nlohmann::json::parse(read_output_file("out/stress.json"));
        EXPECT_EQ(document["complete"], false);
        EXPECT_EQ(document["rows"].size(), 1U);
        for (const char* file : {"out/stress.json", "out/stress.html", "out/stress.md"}) {
            EXPECT_THAT(read_without_escapes(file), HasSubstr("1 of 3 rows: ")) << file;
            EXPECT_THAT(read_without_escapes(file), HasSubstr(why)) << file;
        }
    };
    test::ProcessStartOptions process = make_process_start(words({"N10", "N1", "N9"}));
    process.signal = SIGHUP;
    process.signal_at = "[2/3]";
    expect_one_row(test::run_process(process), 129, "stopped by signal 1");

    const WatchedRun one = run_with_fault_layer(words({"N10"}), std::nullopt);
    ASSERT_EQ(one.ended.exit_code, 0) << one.ended.err;
    for (const auto& [result, exit_code, why] :
         {std::tuple{VK_ERROR_DEVICE_LOST, 76, "VK_ERROR_DEVICE_LOST"},
          std::tuple{VK_ERROR_OUT_OF_HOST_MEMORY, 75, "VK_ERROR_OUT_OF_HOST_MEMORY"}}) {
        fs::remove_all(folder / "out");
        const int images = one.counts.at("vkCreateImage").calls;
        if (exit_code == 75) { // an exhausted device is no lost device: it stays usable
            expect_one_row(
                run_with_fault_layer(words({"N10", "N1", "N9"}),
                                     VulkanCallFault{"vkCreateImage", images + 1, result})
                    .ended,
                exit_code, why);
            fs::remove_all(folder / "out");
        }
        const int waits = one.counts.at("vkWaitSemaphores").calls;
        expect_one_row(run_with_fault_layer(words({"N10", "N1", "N9"}),
                                            VulkanCallFault{"vkWaitSemaphores", waits + 1, result})
                           .ended,
                       exit_code, why);
    }
}

} // namespace
