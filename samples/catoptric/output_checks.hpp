#pragma once

#include "session/engine.hpp"

#include <filesystem>
#include <string>
#include <vector>

// Checks of the files that a verb reads and writes, before anything is rendered.
namespace catoptric::cli {

/// Stdout as an output. If stdout leads to a file, no other output may be the same file.
inline const std::filesystem::path kStdoutPath = "/dev/stdout";

/// Throws `usage` with both names if an output is the same file as an input or another output.
/// Files are compared through links of either kind. Devices and pipes may be named twice. `read`
/// describes an input in the message.
void check_distinct(const std::vector<std::filesystem::path>& outputs,
                    const std::vector<std::filesystem::path>& inputs,
                    const std::string& read = ", which the scene is read from");

/// Returns the path of a file that a verb writes for a device: `output`, or if that is empty the
/// device's file in `folder`, which is made. Checks that the file can be written, so that nothing
/// is measured in vain. `what`: for the message, "profile". Throws `cannot_create` for an empty
/// folder.
std::filesystem::path choose_device_file(const std::string& output,
                                         const std::filesystem::path& folder,
                                         const std::string& what,
                                         const session::DeviceInfo& device);

} // namespace catoptric::cli
