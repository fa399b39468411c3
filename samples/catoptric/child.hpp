#pragma once

#include <atomic>
#include <string>
#include <vector>

namespace catoptric::cli {

/// Runs a program to its end and returns its stdout. The program shares our stderr. If `stop` is
/// set, it is ended by SIGTERM, and the function throws as session::throw_if_stopped does.
/// Throws `missing_input` if the program cannot be started, and `bad_data` for an exit code other
/// than 0.
std::string output_of(const std::vector<std::string>& command, const std::atomic<int>& stop);

} // namespace catoptric::cli
