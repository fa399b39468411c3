#pragma once

#include <functional>
#include <string>

namespace catoptric::cli {

/// All of `main`: returns the exit code, or ends the process at once where a device was abandoned.
/// Once a process.
int run_program(int argc, char** argv);
/// The same of another program's work: what it throws is said on stderr after the program's name.
int run_guarded(const std::string& name, const std::function<int()>& work);

} // namespace catoptric::cli
