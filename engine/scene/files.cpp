#include "scene/files.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <memory>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace catoptric::scene {

namespace fs = std::filesystem;

namespace {

bool lies_below(const fs::path& real, const fs::path& folder) {
    return !folder.empty() &&
           std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
               folder.end();
}

/// Returns a path with all links resolved. Returns an empty path, and sets errno, if the path does
/// not exist or cannot be reached.
fs::path real_path(const fs::path& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                           std::free);
    return real ? fs::path(real.get()) : fs::path();
}

/// A file descriptor that its destructor closes.
struct Descriptor {
    ~Descriptor() {
        if (number >= 0) ::close(number);
    }
    const int number;
};

/// Reads a regular file. Opening a pipe does not block. A link as the last step is not followed, so
/// the file opened is the file named. Throws `missing_input` or `io`.
std::string read_regular(const fs::path& path, const std::string& place, Total& budget) {
    const Descriptor file{
        ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW)};
    const int error = errno;
    check(file.number >= 0, Failure::missing_input, place,
          ": cannot be opened: ", std::generic_category().message(error));
    struct stat facts {};
    const bool known = ::fstat(file.number, &facts) == 0;
    check(known && S_ISREG(facts.st_mode), Failure::missing_input, place, ": wanted a file, found ",
          known && S_ISDIR(facts.st_mode) ? "a folder" : "a device or a pipe");
    const auto size = static_cast<std::size_t>(facts.st_size);
    budget.add(size, place);
    std::string content(size, '\0');
    std::size_t count = 0;
    while (count < size) {
        const ssize_t more = ::read(file.number, content.data() + count, size - count);
        if (more < 0 && errno == EINTR) continue;
        check(more >= 0, Failure::io, place, ": reading failed after ", count, " bytes");
        if (more == 0) break; // the file has become shorter
        count += static_cast<std::size_t>(more);
    }
    content.resize(count);
    return content;
}

} // namespace

Files::Files(const fs::path& scene, const fs::path& root, Account& account)
    : scene_(scene), account_(account) {
    folder_ = real_path(scene.has_parent_path() ? scene.parent_path() : fs::path("."));
    if (root.empty()) return;
    root_ = real_path(root);
    std::error_code error;
    check(fs::is_directory(root_, error), Failure::missing_input,
          "--root: wanted a folder, found '", root.string(), "'");
}

void Files::add(const fs::path& real) {
    if (known_.insert(real.string()).second) found_.push_back(real);
}

std::string Files::read_scene() {
    const fs::path real = real_path(scene_);
    std::string bytes = read_regular(real.empty() ? scene_ : real, scene_.string(),
                                     account_.file_bytes);
    add(real);
    return bytes;
}

void Files::check_place(const fs::path& real, const std::string& name,
                        const std::string& place) const {
    check(lies_below(real, folder_) || lies_below(real, root_), Failure::bad_data, place,
          ": wanted a file below '", folder_.string(), "' or a folder given with --root, found ",
          in_quotes(name), ", which is '", real.string(), "'");
}

fs::path Files::find(const std::string& name, const std::string& place) {
    account_.files.add(1, place);
    check(!name.empty() && name.size() <= kLongestName && name.find('\0') == name.npos,
          Failure::bad_data, place, ": wanted the name of a file, found ", in_quotes(name));
    const fs::path path = folder_ / name;
    fs::path real = real_path(path);
    const int why = errno;
    check_place(real.empty() ? path.lexically_normal() : real, name, place);
    if (real.empty()) {
        const fs::path parent = real_path(path.parent_path());
        if (!parent.empty()) check_place(parent / path.filename(), name, place);
        errno = why;
        return {};
    }
    std::error_code error;
    const fs::file_status status = fs::status(real, error);
    check(fs::is_regular_file(status), Failure::bad_data, place, ": wanted a regular file, found ",
          in_quotes(name), ", which is ",
          fs::is_directory(status) ? "a folder" : "a device or a pipe");
    add(real);
    return real;
}

fs::path Files::get(const std::string& name, const std::string& place) {
    fs::path real = find(name, place);
    const int error = errno; // from realpath(3), if the path was not found
    check(!real.empty(), Failure::missing_input, place, ": ", in_quotes(name),
          error == ENOENT || error == ENOTDIR
              ? " is not there"
              : " cannot be reached: " + std::generic_category().message(error));
    return real;
}

std::string Files::read(const fs::path& real, const std::string& place) {
    return read_regular(real, place + ": " + in_quotes(real.filename().string()),
                        account_.file_bytes);
}

} // namespace catoptric::scene
