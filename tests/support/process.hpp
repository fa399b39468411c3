#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace test {

struct Ended {
    int exit_code = -1; ///< 128 + n when signal n killed it
    std::string out, err;
};

struct Start {
    std::vector<std::string> command;                    ///< the program's path first
    std::map<std::string, std::string> environment = {}; ///< added to ours
    std::string out_path = {}; ///< stdout goes here instead of `Ended::out`
    bool no_reader = false;    ///< stdout is a pipe whose other end is closed
    int signal = 0;            ///< sent once stderr has `signal_at` in it; 0 = none
    std::string signal_at = {};
    std::filesystem::path folder = {}; ///< where it runs; empty = here
};

/// Runs a program to its end.
Ended run_process(const Start& start);

} // namespace test
