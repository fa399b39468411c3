#include "output.hpp"

#include "core/error.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace catoptric::cli {

namespace fs = std::filesystem;

namespace {

/// Returns the printable form of a message, which may quote a file or a name. All lines after the
/// first are indented, so that a quoted name cannot begin a line that looks like a new message.
std::string escape_text(std::string_view text) {
    std::string shown;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find("\n  ", begin), text.size());
        shown += escape(text.substr(begin, end - begin));
        if (end < text.size()) shown += "\n";
        begin = end + 1;
    }
    return shown;
}

void write_stdout(std::string_view bytes) {
    errno = 0;
    const std::size_t written = std::fwrite(bytes.data(), 1, bytes.size(), stdout);
    if (written == bytes.size() && std::fflush(stdout) == 0) return;
    const int error = errno;
    if (error == EPIPE) throw Error(Failure::io, "");
    fail(Failure::io, "stdout: wanted to write ", bytes.size(),
         " bytes: ", std::generic_category().message(error));
}

void check_writable(const fs::path& folder, const fs::path& path) {
    const bool writable = ::access(folder.c_str(), W_OK | X_OK) == 0;
    const int error = errno; // saved before any other call
    check(writable, Failure::cannot_create, path.string(), ": cannot be created in ",
          folder.string(), ": ", std::generic_category().message(error));
}

/// Returns the folder that a new entry `path` would lie in.
fs::path find_parent_folder(const fs::path& path) {
    const fs::path named = path.has_filename() ? path : path.parent_path(); // "out/" means "out"
    return named.has_parent_path() ? named.parent_path() : fs::path(".");
}

void check_parent_folder(const fs::path& path) {
    std::error_code error;
    const fs::path parent = find_parent_folder(path);
    check(fs::is_directory(parent, error), Failure::cannot_create, path.string(),
          ": cannot be created: there is no folder ", parent.string());
    check_writable(parent, path);
}

} // namespace

void prepare_streams() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGCHLD, SIG_DFL); // a parent may have ignored it, and exit codes would be lost
    for (int stream = 0; stream <= 2; ++stream) {
        if (::fcntl(stream, F_GETFD) != -1) continue;
        // `open` returns the lowest free number, which is the number of the closed stream. Stdout
        // is opened for reading, so that writes to it still fail.
        const int opened = ::open("/dev/null", stream == 2 ? O_WRONLY : O_RDONLY);
        static_cast<void>(opened);
    }
}

void print_result(std::string_view result) { write_stdout(escape(result, "\n")); }

void print_bytes(std::string_view result) { write_stdout(result); }

void print_message(const std::string& text) {
    const std::string whole = escape_text(text) + "\n";
    std::fwrite(whole.data(), 1, whole.size(), stderr); // a failure here cannot be reported
}

void print_note(const OutputOptions& output_options, const std::string& text) {
    if (!output_options.quiet) print_message(text);
}

void print_detail(const OutputOptions& output_options, const std::string& text) {
    if (output_options.verbose && !output_options.quiet) print_message(text);
}

void print_warning(const std::string& text) { print_message("catoptric: warning: " + text); }

void throw_incomplete_run(const Error& stopped, std::size_t rows, std::size_t asked,
                          const std::string& where, const fs::path& folder) {
    fail(stopped.failure, stopped.what(), ", after ", rows, " of ", asked, " rows", where,
         folder.empty() ? ""
         : rows == 0    ? "; nothing was written"
                        : "; what there is lies in " + folder.string() + ", marked incomplete");
}

void check_output_file(const fs::path& path) {
    std::error_code error;
    check(!path.empty() && path.has_filename() && !fs::is_directory(path, error),
          Failure::cannot_create, path.string(), ": wanted a file name, found a folder");
    check_parent_folder(path);
}

void check_output_folder(const fs::path& path) {
    check(!path.empty(), Failure::cannot_create, "wanted the name of a folder, found none");
    std::error_code error;
    fs::path there = path; // the path, or its nearest existing parent
    while (!fs::exists(fs::symlink_status(there, error))) there = find_parent_folder(there);
    check(fs::is_directory(there, error), Failure::cannot_create, path.string(),
          ": cannot be created: wanted ", there == path ? "" : there.string() + " to be ",
          "a folder, found a file");
    check_writable(there, path);
}

} // namespace catoptric::cli
