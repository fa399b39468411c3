// Test of case D1 of docs/extremes.md: a command writes the same bytes every time, with no, one or
// two threads of the driver, with or without validation.
#include "faults/faults.hpp"

#include <utility>

namespace {

namespace fs = std::filesystem;

class SameReportBytesTest : public Faults {};

TEST_F(SameReportBytesTest, PicturesDoNotDependOnThreadsOrValidation) {
    Words words = {"compare", "-o",       "out", "--size",  "64x64",       "--frames",
                   "1",       "--warmup", "1",   "--quiet", "--techniques"};
    const nlohmann::json list = nlohmann::json::parse(
        run_cli({"list", "techniques", "--json"}).out)["techniques"];
    for (const auto& technique : list) {
        std::string row = technique["name"].get<std::string>();
        char separator = ':';
        for (const auto& knob : technique["knobs"])
            for (const std::string edge : {"face", "shadow_map"})
                if (knob["name"] == edge)
                    row += std::exchange(separator, ',') + edge + (edge == "face" ? "=64" : "=256");
        words.push_back(row);
    }

    struct ThreadAndPlaceVariant {
        const char* threads;
        bool validate;
    };
    const std::vector<ThreadAndPlaceVariant> ways = {{"2", false}, {"1", false}, {"0", true}};
    std::vector<std::map<std::string, std::string>> pictures(ways.size());
    run_on_two_threads(ways.size(), [&](std::size_t i) {
        const fs::path place = folder / std::to_string(i);
        fs::create_directory(place);
        test::ProcessStartOptions process = make_process_start(words);
        if (ways[i].validate) process.command.insert(process.command.begin() + 2, "--validate");
        process.folder = place;
        process.environment = {{"LP_NUM_THREADS", ways[i].threads}};
        const test::ProcessResult ended = test::run_process(process);
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        for (const auto& entry : fs::directory_iterator(place / "out/images"))
            if (!entry.path().stem().string().ends_with("-error"))
                pictures[i][entry.path().filename()] = read_file_at_path(entry.path());
    });
    EXPECT_EQ(pictures[0].size(), 3 * list.size() + 3); // EXR, PNG and values
    for (std::size_t i = 1; i < ways.size(); ++i) {
        ASSERT_EQ(pictures[i].size(), pictures[0].size());
        for (const auto& [name, bytes] : pictures[0])
            EXPECT_TRUE(pictures[i].at(name) == bytes)
                << name << " is another with " << ways[i].threads << " threads"
                << (ways[i].validate ? " and --validate" : "");
    }
    std::printf("  %zu pictures of %zu techniques, %zu runs\n", pictures[0].size(), list.size(),
                ways.size());
}

} // namespace
