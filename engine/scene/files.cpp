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

bool is_inside_folder(const fs::path& real, const fs::path& folder) {
    return !folder.empty() &&
           std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
               folder.end();
}

/// Returns a path with all links resolved. Returns an empty path, and sets errno, if the path does
/// not exist or cannot be reached.
fs::path resolve_symbolic_links(const fs::path& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                           std::free);
    return real ? fs::path(real.get()) : fs::path();
}

/// A file descriptor that its destructor closes.
struct FileDescriptor {
    ~FileDescriptor() {
        if (number >= 0) ::close(number);
    }
    const int number;
};

/// Reads a regular file. Opening a pipe does not block. A link as the last step is not followed, so
/// the file opened is the file named. Throws `missing_input` or `io`.
std::string read_regular_file(const fs::path& path, const std::string& place,
                              BudgetLimitedSum& budget) {
    const FileDescriptor file{
        ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW)};
    const int error = errno;
    check(file.number >= 0, Failure::missing_input, place,
          ": cannot be opened: ", std::generic_category().message(error));
    struct stat facts {};
    const bool known = ::fstat(file.number, &facts) == 0;
    check(known && S_ISREG(facts.st_mode), Failure::missing_input, place, ": wanted a file, found ",
          known && S_ISDIR(facts.st_mode) ? "a folder" : "a device or a pipe");
    const auto size = static_cast<std::size_t>(facts.st_size);
    budget.add_amount_within_budget(size, place);
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

SceneFileOpener::SceneFileOpener(const fs::path& scene, const fs::path& root,
                                 SceneLoadBudgetUsage& account)
    : scene_(scene), account_(account) {
    folder_ = resolve_symbolic_links(scene.has_parent_path() ? scene.parent_path() : fs::path("."));
    if (root.empty()) return;
    root_ = resolve_symbolic_links(root);
    std::error_code error;
    check(fs::is_directory(root_, error), Failure::missing_input,
          "--root: wanted a folder, found '", root.string(), "'");
}

void SceneFileOpener::add_file(const fs::path& real) {
    if (known_.insert(real.string()).second) found_.push_back(real);
}

std::string SceneFileOpener::read_main_scene_file() {
    const fs::path real = resolve_symbolic_links(scene_);
    std::string bytes = read_regular_file(real.empty() ? scene_ : real, scene_.string(),
                                          account_.file_bytes);
    add_file(real);
    return bytes;
}

void SceneFileOpener::check_file_lies_below_root(const fs::path& real, const std::string& name,
                                                 const std::string& place) const {
    check(is_inside_folder(real, folder_) || is_inside_folder(real, root_), Failure::bad_data,
          place, ": wanted a file below '", folder_.string(),
          "' or a folder given with --root, found ", quote_text_with_escapes(name), ", which is '",
          real.string(), "'");
}

fs::path SceneFileOpener::find_scene_file_by_name(const std::string& name,
                                                  const std::string& place) {
    account_.files.add_amount_within_budget(1, place);
    check(!name.empty() && name.size() <= kMaxFileNameLength && name.find('\0') == name.npos,
          Failure::bad_data, place, ": wanted the name of a file, found ",
          quote_text_with_escapes(name));
    const fs::path path = folder_ / name;
    fs::path real = resolve_symbolic_links(path);
    const int why = errno;
    check_file_lies_below_root(real.empty() ? path.lexically_normal() : real, name, place);
    if (real.empty()) {
        const fs::path parent = resolve_symbolic_links(path.parent_path());
        if (!parent.empty()) check_file_lies_below_root(parent / path.filename(), name, place);
        errno = why;
        return {};
    }
    std::error_code error;
    const fs::file_status status = fs::status(real, error);
    check(fs::is_regular_file(status), Failure::bad_data, place, ": wanted a regular file, found ",
          quote_text_with_escapes(name), ", which is ",
          fs::is_directory(status) ? "a folder" : "a device or a pipe");
    add_file(real);
    return real;
}

fs::path SceneFileOpener::find_required_scene_file(const std::string& name,
                                                   const std::string& place) {
    fs::path real = find_scene_file_by_name(name, place);
    const int error = errno; // from realpath(3), if the path was not found
    check(!real.empty(), Failure::missing_input, place, ": ", quote_text_with_escapes(name),
          error == ENOENT || error == ENOTDIR
              ? " is not there"
              : " cannot be reached: " + std::generic_category().message(error));
    return real;
}

std::string SceneFileOpener::read_file_content(const fs::path& real, const std::string& place) {
    return read_regular_file(real, place + ": " + quote_text_with_escapes(real.filename().string()),
                             account_.file_bytes);
}

} // namespace catoptric::scene
