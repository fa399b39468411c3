#pragma once

#include "places.hpp"
#include "support/folder.hpp"
#include "support/process.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <fstream>
#include <iterator>

/// Fixture for tests that run the program `catoptric` in a temporary folder, which is deleted after
/// the test.
class CommandLineTest : public test::InFolder {
protected:
    using Words = std::vector<std::string>;

    test::ProcessStartOptions make_process_start(const Words& words) const {
        test::ProcessStartOptions start{.command = {CATOPTRIC_CLI}};
        start.command.insert(start.command.end(), words.begin(), words.end());
        start.folder = folder;
        return start;
    }
    test::ProcessResult run_cli(const Words& words) const {
        return test::run_process(make_process_start(words));
    }

    /// Appends options for one small and quick frame to the command line of a verb that renders.
    static Words add_small_frame_options(Words words) {
        words.insert(words.end(), {"--size", "32x32", "--frames", "1", "--warmup", "1"});
        return words;
    }

    /// Runs the program and expects the exit code, an empty stdout, and every one of `parts` in
    /// stderr.
    void expect_usage_refused(const Words& words, int exit_code, const Words& parts) const {
        expect_exit_code(run_cli(words), exit_code, parts);
    }
    static void expect_exit_code(const test::ProcessResult& ended, int exit_code,
                                 const Words& parts) {
        EXPECT_EQ(ended.exit_code, exit_code) << ended.err;
        EXPECT_EQ(ended.out, "");
        // On a slow machine, lines of progress come first.
        EXPECT_THAT(ended.err, testing::ContainsRegex("(^|\n)catoptric: "));
        for (const std::string& part : parts) EXPECT_THAT(ended.err, testing::HasSubstr(part));
    }

    void write_input_file(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    std::string read_output_file(const std::string& name) const {
        return read_file_at_path(folder / name);
    }
    static std::string read_file_at_path(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
};
