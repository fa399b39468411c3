#pragma once

#include "core/error.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace catoptric::cli {

enum class ProgressMode { automatic, always, never };

/// How a verb writes its output. Only the result goes to stdout.
struct OutputOptions {
    bool json = false;
    bool quiet = false;
    bool verbose = false;
    ProgressMode progress = ProgressMode::automatic;
};

/// Prepares stdin, stdout and stderr. A write to a closed pipe or beyond the file size limit fails
/// instead of killing the program. Files opened later cannot take the place of a closed stream.
void prepare_streams();

/// Writes the result, text or JSON, to stdout and flushes it. Escapes characters that a terminal
/// might obey (`escape`). Throws `Failure::io`, without a message if the reader has gone.
void print_result(std::string_view result);
/// Writes the bytes of a picture to stdout unchanged and flushes them. Throws as `print_result`
/// does.
void print_bytes(std::string_view result);
/// Writes one message to stderr, with the same characters escaped as by `print_result`. In a
/// message of several lines, all lines but the first begin with two spaces. Other line breaks are
/// escaped.
void print_message(const std::string& text);

/// Writes a line to stderr: `print_note` unless --quiet, `print_detail` only with -v,
/// `print_warning` always.
void print_note(const OutputOptions& output_options, const std::string& text);
void print_detail(const OutputOptions& output_options, const std::string& text);
void print_warning(const std::string& text);

/// Throws the error that ended a run early, with the number of finished rows and their folder.
/// `folder` is the folder of the finished rows, or empty. The message has `where` after the rows.
[[noreturn]] void throw_incomplete_run(const Error& stopped, std::size_t rows, std::size_t asked,
                                       const std::string& where,
                                       const std::filesystem::path& folder);

/// Throws `cannot_create` if no file can be made at `path`, before work is spent on it. Reasons are
/// a missing folder, or a folder of this name.
void check_output_file(const std::filesystem::path& path);
/// Throws `cannot_create` if the folder and its parents cannot be made. The nearest existing parent
/// must be a folder that accepts entries.
void check_output_folder(const std::filesystem::path& path);

} // namespace catoptric::cli
