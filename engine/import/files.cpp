#include "import/files.hpp"

#include "core/text.hpp"

#include <algorithm>
#include <cctype>
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
fs::path resolve_links(const fs::path& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(::realpath(path.c_str(), nullptr),
                                                           std::free);
    return real ? fs::path(real.get()) : fs::path();
}

std::string to_lower(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::string_view trim_spaces(std::string_view text) {
    constexpr std::string_view kSpaces = " \t";
    const std::size_t first = text.find_first_not_of(kSpaces);
    return first == text.npos ? std::string_view()
                              : text.substr(first, text.find_last_not_of(kSpaces) + 1 - first);
}

/// What a written name may mean: itself, without a comment behind it, without quotes, all with
/// slashes; and the last steps of these.
struct NameMeanings {
    std::vector<std::string> whole, last_steps;
};

NameMeanings meanings_of(std::string_view written) {
    NameMeanings names;
    names.whole.emplace_back(trim_spaces(written));
    const std::size_t comment = written.find(" #");
    if (comment != written.npos) names.whole.emplace_back(trim_spaces(written.substr(0, comment)));
    for (std::size_t i = 0, count = names.whole.size(); i < count; ++i) {
        const std::string& name = names.whole[i];
        if (name.size() > 2 && (name.front() == '"' || name.front() == '\'') &&
            name.back() == name.front())
            names.whole.push_back(name.substr(1, name.size() - 2));
    }
    for (std::string& name : names.whole) {
        std::ranges::replace(name, '\\', '/');
        const std::size_t last = name.rfind('/');
        if (last != name.npos && last + 1 < name.size())
            names.last_steps.push_back(name.substr(last + 1));
    }
    std::erase(names.whole, "");
    return names;
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
std::string read_regular_file(const fs::path& path, const std::string& place, LimitedSum& budget) {
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

FileOpener::FileOpener(const fs::path& scene, const fs::path& root, LoadAccount& account)
    : scene_(scene), account_(account) {
    folder_ = resolve_links(scene.has_parent_path() ? scene.parent_path() : fs::path("."));
    if (root.empty()) return;
    root_ = resolve_links(root);
    std::error_code error;
    check(fs::is_directory(root_, error), Failure::missing_input,
          "--root: wanted a folder, found '", root.string(), "'");
}

void FileOpener::add_file(const fs::path& real) {
    if (known_.insert(real.string()).second) found_.push_back(real);
}

std::string FileOpener::read_main() {
    const fs::path real = resolve_links(scene_);
    std::string bytes = read_regular_file(real.empty() ? scene_ : real, scene_.string(),
                                          account_.file_bytes);
    add_file(real);
    return bytes;
}

void FileOpener::check_allowed(const fs::path& real, const std::string& name,
                               const std::string& place) const {
    check(is_inside_folder(real, folder_) || is_inside_folder(real, root_), Failure::bad_data,
          place, ": wanted a file below '", folder_.string(),
          "' or a folder given with --root, found ", quote(name), ", which is '", real.string(),
          "'");
}

fs::path FileOpener::find(const std::string& name, const std::string& place) {
    account_.files.add(1, place);
    check(!name.empty() && name.size() <= kMaxNameLength && name.find('\0') == name.npos,
          Failure::bad_data, place, ": wanted the name of a file, found ", quote(name));
    const fs::path path = folder_ / name;
    fs::path real = resolve_links(path);
    const int why = errno;
    check_allowed(real.empty() ? path.lexically_normal() : real, name, place);
    if (real.empty()) {
        const fs::path parent = resolve_links(path.parent_path());
        if (!parent.empty()) check_allowed(parent / path.filename(), name, place);
        errno = why;
        return {};
    }
    std::error_code error;
    const fs::file_status status = fs::status(real, error);
    check(fs::is_regular_file(status), Failure::bad_data, place, ": wanted a regular file, found ",
          quote(name), ", which is ", fs::is_directory(status) ? "a folder" : "a device or a pipe");
    add_file(real);
    return real;
}

bool FileOpener::is_allowed(const fs::path& real) const {
    std::error_code error;
    return (is_inside_folder(real, folder_) || is_inside_folder(real, root_)) &&
           fs::is_regular_file(real, error);
}

const FileOpener::FolderListing& FileOpener::list_folder(const fs::path& folder) {
    constexpr int kMaxFolderEntries = 65536;
    const auto [entry, is_new] = listings_.try_emplace(folder);
    if (!is_new) return entry->second;
    std::error_code error;
    int count = 0;
    for (fs::directory_iterator at(folder, error), end;
         !error && at != end && count < kMaxFolderEntries; at.increment(error), ++count) {
        const std::string file = at->path().filename().string();
        const auto [name, is_first] = entry->second.try_emplace(to_lower(file), file);
        if (!is_first) name->second = std::min(name->second, file);
    }
    return entry->second;
}

fs::path FileOpener::find_in_any_case(const fs::path& folder, const fs::path& name) {
    fs::path found = folder;
    std::error_code error;
    for (const fs::path& step : name) {
        if (step == ".." || step.is_absolute()) return {}; // no folder outside is listed
        if (!fs::exists(found / step, error)) {
            const FolderListing& listing = list_folder(found);
            const auto file = listing.find(to_lower(step.string()));
            if (file == listing.end()) return {};
            found /= file->second;
        } else {
            found /= step;
        }
    }
    return found;
}

fs::path FileOpener::find_as_written(std::string_view written, const fs::path& folder,
                                     const std::string& place) {
    const NameMeanings names = meanings_of(written);
    const std::string first = names.whole.empty() ? std::string(written) : names.whole.front();
    if (written.size() > kMaxNameLength || written.find('\0') != written.npos)
        return find(first, place); // refuses the name
    for (const std::vector<std::string>* const list : {&names.whole, &names.last_steps})
        for (const std::string& name : *list)
            for (const bool any_case : {false, true})
                for (const fs::path& from : {folder, folder_}) {
                    const fs::path path = any_case ? find_in_any_case(from, name) : from / name;
                    const fs::path real = resolve_links(path);
                    if (real.empty()) continue;
                    // A file that is there, but may not be read, is meant none the less.
                    if (!is_allowed(real)) {
                        check_allowed(real, name, place);
                        return find(path.string(), place);
                    }
                    account_.files.add(1, place);
                    add_file(real);
                    return real;
                }
    return find(first, place); // says whether the name leads out of the folder
}

fs::path FileOpener::find_required(const std::string& name, const std::string& place) {
    fs::path real = find(name, place);
    const int error = errno; // from realpath(3), if the path was not found
    check(!real.empty(), Failure::missing_input, place, ": ", quote(name),
          error == ENOENT || error == ENOTDIR
              ? " is not there"
              : " cannot be reached: " + std::generic_category().message(error));
    return real;
}

std::string FileOpener::read(const fs::path& real, const std::string& place) {
    return read_regular_file(real, place + ": " + quote(real.filename().string()),
                             account_.file_bytes);
}

} // namespace catoptric::scene
