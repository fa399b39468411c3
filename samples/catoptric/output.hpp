#pragma once

#include "core/error.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace catoptric::cli {

enum class ProgressMode { automatic, always, never };

/// How a verb talks. The result is all that goes to stdout.
struct Manners {
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    ProgressMode progress = ProgressMode::automatic;
};

/// Makes a write to a closed pipe or over the limit of file sizes fail instead of killing the
/// program, and keeps files that are opened later from becoming a closed stdin, stdout or stderr.
void prepare_streams();

/// Writes and flushes the result, text or JSON, without what a terminal might obey (`printable`, of
/// whole lines). Throws `Failure::io`, without text where the reader has gone.
void put(std::string_view result);
/// The same of a picture, every byte as it is.
void put_bytes(std::string_view result);
/// Writes one message to stderr, as `put` does. Of several lines all but the first begin with two
/// spaces; other line breaks are written out.
void say(const std::string& text);

/// Lines on stderr: what may interest (not with --quiet), what only -v shows, what must be seen.
void note(const Manners& manners, const std::string& text);
void detail(const Manners& manners, const std::string& text);
void warn(const std::string& text);

/// Throws what ended a run early, with how many rows it has and where they lie: nowhere if `folder`
/// is empty. `where` is said after the rows.
[[noreturn]] void fail_incomplete(const Error& stopped, std::size_t rows, std::size_t asked,
                                  const std::string& where, const std::filesystem::path& folder);

/// Throws `cannot_create` where a file cannot be made at `path`, before work is spent on it: its
/// folder is missing, or the name is a folder's.
void check_file_can_be_made(const std::filesystem::path& path);
/// The same for a folder, which is made with its parents: the nearest of them that is there is a
/// folder and takes entries.
void check_folder_can_be_made(const std::filesystem::path& path);

} // namespace catoptric::cli
