#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace catoptric::cli {

/// Runs a program to its end, its stderr ours, and returns its stdout. Ends it with SIGTERM where
/// `stop` says so, and throws as app::Watcher::check_stopped does. Throws `missing_input` where it
/// cannot be started, `bad_data` with how it ended where that is not exit code 0.
std::string output_of(const std::vector<std::string>& command, const std::atomic<int>& stop);

} // namespace catoptric::cli
