#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace test {

struct Ended {
    int exit_code = -1; ///< 128 + n when signal n killed it
    std::string out, err;
    double seconds = 0;              ///< from its start to its end
    std::uint64_t peak_bytes = 0;    ///< most memory that was resident
    double seconds_after_signal = 0; ///< from the signal that was sent, if one was
};

struct Start {
    std::vector<std::string> command;                    ///< the program's path first
    std::map<std::string, std::string> environment = {}; ///< added to ours
    std::string out_path = {};       ///< stdout goes here instead of `Ended::out`
    bool no_reader = false;          ///< stdout is a pipe whose other end is closed
    std::uint64_t file_limit = 0;    ///< bytes after which writing to a file fails; 0 = no limit
    std::uint64_t memory_limit = 0;  ///< bytes of address space; 0 = no limit
    std::uint64_t seconds_limit = 0; ///< processor time after which it is killed; 0 = no limit
    int signal = 0;                  ///< sent once stderr has `signal_at` in it; 0 = none
    std::string signal_at = {};
    std::chrono::milliseconds signal_after{0}; ///< from then
    std::chrono::milliseconds again_after{0};  ///< from the signal to the same once more; 0 = once
    std::filesystem::path folder = {};         ///< where it runs; empty = here
};

/// Runs a program to its end.
Ended run_process(const Start& start);

/// Runs `work` in a copy of this process, which then ends at once, without its destructors. Returns
/// what it returned, with the signal or exception that ended it in words.
std::string in_child(const std::function<std::string()>& work);

} // namespace test
