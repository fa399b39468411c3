#pragma once

#include <filesystem>
#include <string>
#include <vector>

// What a verb reads and what it writes, before anything is rendered.
namespace catoptric::cli {

/// Stdout as an output among others: where it leads to a file, that must be no other one.
inline const std::filesystem::path kStdout = "/dev/stdout";

/// Throws `usage` naming both where an output is one of the inputs or another output: the same file
/// by any path, through links of either kind. Devices and pipes may be named twice. `read`: what is
/// said of an input.
void check_apart(const std::vector<std::filesystem::path>& outputs,
                 const std::vector<std::filesystem::path>& inputs,
                 const std::string& read = ", which the scene is read from");

} // namespace catoptric::cli
