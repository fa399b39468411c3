#pragma once

#include <string>
#include <vector>

// Other programs that this program runs where they are installed.
namespace catoptric::cli {

/// Returns the path of an executable file in a folder of PATH; empty: none.
std::string find_program(const std::string& name);

/// Runs a program to its end, which should come within moments: signals do not end the wait. Its
/// output to stdout is dropped, and its errors go to stderr. `words`: its path and its arguments.
/// Throws `missing_input` if it cannot be started, and `io`, with `name` first, unless it exits
/// with 0.
void run_external(const std::vector<std::string>& words, const std::string& name);

} // namespace catoptric::cli
