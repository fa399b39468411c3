#pragma once

namespace catoptric::cli {

/// All of `main`: returns the exit code, or ends the process at once where a device was abandoned.
/// Once a process.
int run_program(int argc, char** argv);

} // namespace catoptric::cli
