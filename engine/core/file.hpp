#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace catoptric {

/// Where bytes written to `path` finally lie: absolute, without `.` and `..`, at the end of all
/// links. Nothing need be there.
std::filesystem::path real_path(const std::filesystem::path& path);

/// Puts `content` at `path`: written to a temporary in the same folder, flushed, closed, renamed,
/// so that readers see the old file or the whole new one, with the old one's mode. A link is
/// followed; a device or pipe is
/// written in place. Throws `cannot_create` when nothing can be opened there, `io` when writing
/// fails; then the temporary is gone and an old file is untouched.
void write_file(const std::filesystem::path& path, std::string_view content);
void write_file(const std::filesystem::path& path, std::span<const std::byte> content);

/// The bytes of a file. Throws `missing_input` when it is not there or cannot be opened, `io` when
/// reading fails half-way.
std::string read_file(const std::filesystem::path& path);

} // namespace catoptric
