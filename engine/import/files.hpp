#pragma once

#include "import/budget.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace catoptric::scene {

/// Opens the files of one scene. A file that the scene names is opened by its real path, with links
/// resolved. The real path must lie below the real folder of the scene's path, or below `root`.
/// Hard links cannot be told from other files.
class FileOpener {
public:
    /// Longest file name in bytes. Names are limited because each step of a path costs a system
    /// call.
    static constexpr std::size_t kMaxNameLength = 1024;

    /// Takes the path of the scene, and a second folder or an empty path. Throws `missing_input` if
    /// `root` is not a folder.
    FileOpener(const std::filesystem::path& scene, const std::filesystem::path& root,
               LoadAccount& account);

    /// Returns the bytes of the scene file, which may lie anywhere. Throws `missing_input`, or `io`
    /// if reading fails.
    std::string read_main();

    /// Returns the real path of a file that the scene names, or an empty path if it does not exist.
    /// Throws `bad_data` beginning with `place` for a file outside the allowed folders, a file that
    /// is not regular, or a name longer than 1024 bytes.
    std::filesystem::path find(const std::string& name, const std::string& place);

    /// Does the same for a name as programs write it into .obj and .mtl files: perhaps in quotes,
    /// with backslashes, a comment behind it, another case of letters or the folders of another
    /// machine. Looks in `folder`, then beside the scene: for the whole name, then for its last
    /// step. Letters of another case count only if no file has the name itself.
    std::filesystem::path find_as_written(std::string_view written,
                                          const std::filesystem::path& folder,
                                          const std::string& place);

    /// Does the same as `find`, but throws `missing_input` if the file does not exist.
    std::filesystem::path find_required(const std::string& name, const std::string& place);

    /// Returns the bytes of a file that `find` has found. Throws `missing_input` or `io`.
    std::string read(const std::filesystem::path& real, const std::string& place);

    /// Returns the real paths of the scene and of all files found, each once, in order of the
    /// calls.
    const std::vector<std::filesystem::path>& found() const { return found_; }

private:
    using FolderListing = std::map<std::string, std::string>; ///< names by their lower-case letters

    const FolderListing& list_folder(const std::filesystem::path& folder);
    /// Returns the path of `name` below `folder` with the letter case of the files on the disk, or
    /// an empty path. If several fit, the first in alphabetical order.
    std::filesystem::path find_in_any_case(const std::filesystem::path& folder,
                                           const std::filesystem::path& name);
    bool is_allowed(const std::filesystem::path& real) const;
    void add_file(const std::filesystem::path& real);
    void check_allowed(const std::filesystem::path& real, const std::string& name,
                       const std::string& place) const;

    std::filesystem::path scene_, folder_, root_;
    LoadAccount& account_;
    std::vector<std::filesystem::path> found_;
    std::unordered_set<std::string> known_; ///< the paths in `found_`, for lookup
    std::map<std::filesystem::path, FolderListing> listings_;
};

} // namespace catoptric::scene
