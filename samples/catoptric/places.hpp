#pragma once

#include "scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

// What a verb reads and what it writes, before anything is rendered.
namespace catoptric::cli {

/// The files that `scene`, which was called `name` on the command line, was read from. None for a
/// built-in one.
std::vector<std::filesystem::path> input_files(const scene::Scene& scene, const std::string& name);

/// Stdout as an output among others: where it leads to a file, that must be no other one.
inline const std::filesystem::path kStdout = "/dev/stdout";

/// Throws `usage` naming both where an output is one of the inputs or another output: the same file
/// by any path, through links of either kind. Devices and pipes may be named twice.
void check_apart(const std::vector<std::filesystem::path>& outputs,
                 const std::vector<std::filesystem::path>& inputs);

} // namespace catoptric::cli
