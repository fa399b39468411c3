#include "output_checks.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "output.hpp"
#include "report.hpp"
#include "session/profile.hpp"

#include <map>
#include <utility>

#include <sys/stat.h>

namespace catoptric::cli {

namespace fs = std::filesystem;

namespace {

/// Files by their resolved path and, if they exist, by inode number.
class KnownFiles {
public:
    struct KnownFile {
        fs::path path; ///< path as the user named it
        bool is_input = false;
    };
    /// Returns the known file to which `path` also leads; null if there is none. Devices and pipes
    /// never count as the same file.
    const KnownFile* find(const fs::path& path) const {
        struct stat status {};
        const bool is_there = ::stat(path.c_str(), &status) == 0;
        if (is_there && !S_ISREG(status.st_mode)) return nullptr;
        if (const auto found = paths_.find(real_path(path)); found != paths_.end())
            return &found->second;
        const auto found = numbers_.find({status.st_dev, status.st_ino});
        return is_there && found != numbers_.end() ? &found->second : nullptr;
    }
    void add(const KnownFile& file) {
        paths_.emplace(real_path(file.path), file);
        struct stat status {};
        if (::stat(file.path.c_str(), &status) == 0)
            numbers_.emplace(std::pair(status.st_dev, status.st_ino), file);
    }

private:
    std::map<fs::path, KnownFile> paths_;
    std::map<std::pair<dev_t, ino_t>, KnownFile> numbers_;
};

} // namespace

void check_distinct(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs,
                    const std::string& read) {
    KnownFiles files;
    for (const fs::path& input : inputs) files.add({input, true});
    for (const fs::path& output : outputs) {
        if (const KnownFiles::KnownFile* same = files.find(output)) {
            check(same->is_input || same->path != output, Failure::usage, output.string(),
                  ": wanted one output in a place, found two");
            fail(Failure::usage, output.string(), ": cannot be written: it is the same file as ",
                 same->path.string(), same->is_input ? read : ", which is written too");
        }
        files.add({output, false});
    }
}

fs::path choose_device_file(const std::string& output, const fs::path& folder,
                            const std::string& what, const session::DeviceInfo& device) {
    if (!output.empty()) {
        check_output_file(output);
        return output;
    }
    check(!folder.empty(), Failure::cannot_create, "no folder for the device's ", what,
          ": wanted XDG_CONFIG_HOME or HOME to be an absolute path; -o FILE writes it elsewhere");
    report::create_folder(folder);
    check_output_file(folder / session::profile_file_name(device));
    return folder / session::profile_file_name(device);
}

} // namespace catoptric::cli
