#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace test {

struct ProcessResult {
    int exit_code = -1; ///< 128 + n if signal n ended the process
    std::string out, err;
    double seconds = 0;              ///< seconds from the start of the process to its end
    double processor_seconds = 0;    ///< processor time of all its threads
    std::uint64_t peak_bytes = 0;    ///< largest resident memory
    double seconds_after_signal = 0; ///< seconds from the signal to the end; 0: no signal sent
};

struct ProcessStartOptions {
    /// The path of the program, then its arguments.
    std::vector<std::string> command;
    /// Variables that are added to the environment of this process.
    std::map<std::string, std::string> environment = {};
    std::string out_path = {};       ///< file for stdout, instead of `ProcessResult::out`
    bool no_reader = false;          ///< stdout is a pipe whose other end is closed
    std::uint64_t file_limit = 0;    ///< bytes after which writing to a file fails; 0 = no limit
    std::uint64_t memory_limit = 0;  ///< largest address space in bytes; 0 = no limit
    std::uint64_t seconds_limit = 0; ///< processor time after which the system kills it; 0 = none
    int signal = 0;                  ///< signal to send once stderr contains `signal_at`; 0 = none
    std::string signal_at = {};
    std::chrono::milliseconds signal_after{0}; ///< delay between `signal_at` and the signal
    std::chrono::milliseconds again_after{0};  ///< delay until the signal is sent again; 0 = once
    std::filesystem::path folder = {};         ///< working folder; empty = the current one
};

/// Runs a program until it ends and returns its exit code, output, time and memory.
ProcessResult run_process(const ProcessStartOptions& start);

/// Runs `work` in a forked copy of this process, which then ends without running destructors.
/// Returns the text that `work` returned. If a signal or an exception ended the copy, the text says
/// which one.
std::string run_in_forked_process(const std::function<std::string()>& work);

} // namespace test
