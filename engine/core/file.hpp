#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace catoptric {

/// Returns the path at which bytes written to `path` end up: absolute, without `.` and `..`, with
/// all links followed. The file need not exist.
std::filesystem::path real_path(const std::filesystem::path& path);

/// Writes `content` to `path` through a temporary file in the same folder, which is flushed, closed
/// and renamed. Readers see the old file or the whole new one. The new file keeps the mode of the
/// old one. A link is followed. A device or pipe is written in place. Throws `cannot_create` if no
/// file can be opened there and `io` if writing fails. Then the temporary is removed and an old
/// file is unchanged.
void write_file(const std::filesystem::path& path, std::string_view content);
void write_file(const std::filesystem::path& path, std::span<const std::byte> content);

/// A file that another program writes whole or not at all: the program writes to `temporary`, and
/// `commit` puts the finished file in place. Without that call the temporary is removed.
class PartialFile {
public:
    /// Removes temporaries of `path` that dead processes have left. Throws `cannot_create` if
    /// `path` names a folder, a device or a pipe.
    explicit PartialFile(std::filesystem::path path);
    ~PartialFile();
    PartialFile(const PartialFile&) = delete;
    PartialFile& operator=(const PartialFile&) = delete;

    /// Returns a path in the folder of the target at which no file exists at first.
    const std::filesystem::path& temporary() const { return temporary_; }
    /// Gives the temporary the mode of the old file, if there is one. Throws `io`.
    void copy_mode() const;
    /// Renames the temporary. Throws `io`.
    void commit();

private:
    std::filesystem::path named_, target_, temporary_;
};

/// Returns the bytes of a file. Throws `missing_input` if it does not exist or cannot be opened,
/// `io` if reading fails, and `bad_data` for a pipe or a device with more than 512 MiB.
std::string read_file(const std::filesystem::path& path);

} // namespace catoptric
