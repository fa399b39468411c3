#include "core/file.hpp"

#include "core/error.hpp"
#include "core/watch.hpp"

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>

#include <unistd.h>

namespace catoptric {

namespace fs = std::filesystem;

namespace {

const std::string kPartialSuffix = ".partial-";

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

std::string error_text(int error) { return std::generic_category().message(error); }

/// Returns the path at the end of all links, which need not exist.
fs::path follow_links(fs::path path) {
    std::error_code error;
    for (int link = 0; link < 40 && fs::is_symlink(fs::symlink_status(path, error)); ++link)
        path = path.parent_path() / fs::read_symlink(path, error);
    return path;
}

/// Writes, flushes and closes the file. Throws `io` with `path`, not with the temporary's name.
void write_whole(FileHandle file, std::string_view content, const fs::path& path) {
    const std::size_t written = content.empty()
                                    ? 0
                                    : std::fwrite(content.data(), 1, content.size(), file.get());
    const bool whole = written == content.size() && std::fflush(file.get()) == 0;
    const int error = errno;
    check(whole, Failure::io, path.string(), ": wanted to write ", content.size(),
          " bytes: ", error_text(error));
    const bool closed = std::fclose(file.release()) == 0;
    const int close_error = errno;
    check(closed, Failure::io, path.string(), ": cannot be closed: ", error_text(close_error));
}

FileHandle open_new_file(const fs::path& temporary, const fs::path& path) {
    FileHandle file(std::fopen(temporary.c_str(), "wbx"));
    const int error = errno;
    check(file != nullptr, Failure::cannot_create, path.string(),
          ": cannot be created: ", error_text(error));
    return file;
}

/// Returns the path of a new temporary of this target: TARGET.partial-PROCESS-NUMBER. Threads of a
/// process may write the same target, each through a temporary of its own.
fs::path make_temporary(const fs::path& target) {
    static std::atomic<std::uint64_t> number = 0;
    fs::path path = target;
    path += kPartialSuffix + std::to_string(::getpid()) + "-" + std::to_string(++number);
    return path;
}

/// Removes temporaries of this target whose processes have ended. A program that gets a second
/// signal cannot remove its own.
void remove_stale(const fs::path& target) {
    const std::string beginning = target.filename().string() + kPartialSuffix;
    std::error_code error;
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with(beginning)) continue;
        int process = 0;
        const char *first = name.data() + beginning.size(), *last = name.data() + name.size();
        std::from_chars_result read = std::from_chars(first, last, process);
        if (read.ec != std::errc() || process <= 0) continue;
        if (std::uint64_t number = 0; read.ptr != last && *read.ptr == '-')
            read = std::from_chars(read.ptr + 1, last, number);
        if (read.ec != std::errc() || read.ptr != last) continue;
        if (::kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), error);
    }
}

} // namespace

fs::path real_path(const fs::path& path) {
    std::error_code error;
    const fs::path target = fs::absolute(follow_links(path), error);
    const fs::path real = fs::weakly_canonical(target, error);
    // An error is, for example, an unreadable folder.
    return error ? target.lexically_normal() : real;
}

PartialFile::PartialFile(fs::path path) : named_(std::move(path)), target_(follow_links(named_)) {
    std::error_code error;
    const fs::file_status status = fs::status(target_, error);
    check(target_.has_filename() && (!fs::exists(status) || fs::is_regular_file(status)),
          Failure::cannot_create, named_.string(), ": wanted a file name, found ",
          fs::is_directory(status) || !target_.has_filename() ? "a folder" : "a device or pipe");
    remove_stale(target_);
    do temporary_ = make_temporary(target_);
    while (fs::exists(temporary_, error)); // left by a dead process with our process id
}

PartialFile::~PartialFile() {
    std::error_code error;
    if (!temporary_.empty()) fs::remove(temporary_, error);
}

void PartialFile::copy_mode() const {
    std::error_code error;
    const fs::file_status old = fs::status(target_, error);
    if (!fs::exists(old)) return;
    fs::permissions(temporary_, old.permissions(), error);
    check(!error, Failure::io, named_.string(),
          ": cannot be given the mode of the file in its place: ", error.message());
}

void PartialFile::commit() {
    std::error_code error;
    fs::rename(temporary_, target_, error);
    check(!error, Failure::io, named_.string(), ": cannot be replaced: ", error.message());
    temporary_.clear();
}

void write_file(const fs::path& path, std::string_view content) {
    look_at_stop();
    std::error_code error;
    const fs::path target = follow_links(path);
    const fs::file_status status = fs::status(target, error);
    check(!fs::is_directory(status) && target.has_filename(), Failure::cannot_create, path.string(),
          ": wanted a file name, found a folder");
    if (!fs::exists(status) || fs::is_regular_file(status)) {
        PartialFile partial(path);
        FileHandle file = open_new_file(partial.temporary(), path);
        partial.copy_mode();
        write_whole(std::move(file), content, path);
        return partial.commit();
    }

    FileHandle file(std::fopen(target.c_str(), "wb")); // the target is a device or a pipe
    const int open_error = errno;
    check(file != nullptr, Failure::cannot_create, path.string(),
          ": cannot be opened: ", error_text(open_error));
    write_whole(std::move(file), content, path);
}

void write_file(const fs::path& path, std::span<const std::byte> content) {
    const auto* bytes = reinterpret_cast<const char*>(content.data());
    write_file(path, std::string_view(bytes, content.size()));
}

std::string read_file(const fs::path& path) {
    constexpr std::size_t kMaxStreamBytes = std::size_t{512} << 20;
    std::error_code ignored;
    const bool is_stream = !fs::is_regular_file(path, ignored);
    check(!fs::is_directory(path, ignored), Failure::missing_input, path.string(),
          ": wanted a file, found a folder");
    const FileHandle file(std::fopen(path.c_str(), "rb"));
    const int error = errno;
    check(file != nullptr, Failure::missing_input, path.string(),
          ": cannot be opened: ", error_text(error));
    std::string content;
    char block[1 << 16];
    while (const std::size_t count = std::fread(block, 1, sizeof block, file.get())) {
        check(!is_stream || content.size() + count <= kMaxStreamBytes, Failure::bad_data,
              path.string(), ": wanted at most ", kMaxStreamBytes,
              " bytes of a pipe or a device, found more");
        content.append(block, count);
    }
    check(std::ferror(file.get()) == 0, Failure::io, path.string(), ": reading failed after ",
          content.size(), " bytes");
    return content;
}

} // namespace catoptric
