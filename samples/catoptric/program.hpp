#pragma once

#include <functional>
#include <string>

namespace catoptric::cli {

/// Runs the whole program and returns the exit code. Ends the process at once if a device was
/// abandoned. May be called once per process.
int run_program(int argc, char** argv);
/// Runs `work` for another program, and turns errors into exit codes as run_program() does. Error
/// messages go to stderr after the program's name.
int run_catching(const std::string& name, const std::function<int()>& work);

} // namespace catoptric::cli
