#pragma once

#include "scene/account.hpp"

#include <filesystem>
#include <string>
#include <unordered_set>
#include <vector>

namespace catoptric::scene {

/// The files that one scene is made of. What a scene names is opened by its real path, links
/// followed, and only if that lies below the real folder in which the scene was named, or below
/// `root`. Hard links cannot be told from files.
class Files {
public:
    static constexpr std::size_t kLongestName = 1024; ///< bytes; every step of a path costs a call

    /// Throws `missing_input` for a `root` that is no folder; empty: none.
    Files(const std::filesystem::path& scene, const std::filesystem::path& root, Account& account);

    /// The scene itself, wherever it lies. Throws `missing_input`, or `io` when reading fails.
    std::string read_scene();

    /// The real path of a file that the scene names; empty when nothing is there. Throws `bad_data`
    /// beginning with `place` for one that lies elsewhere, is no regular file, or has a name of
    /// more than 1024 bytes.
    std::filesystem::path find(const std::string& name, const std::string& place);

    /// As `find`; throws `missing_input` when nothing is there.
    std::filesystem::path get(const std::string& name, const std::string& place);

    /// The bytes of what `find` has found. Throws `missing_input` or `io`.
    std::string read(const std::filesystem::path& real, const std::string& place);

    /// Real paths of the scene and of everything found, in the order in which that happened.
    const std::vector<std::filesystem::path>& found() const { return found_; }

private:
    void add(const std::filesystem::path& real);
    void check_place(const std::filesystem::path& real, const std::string& name,
                     const std::string& place) const;

    std::filesystem::path scene_, folder_, root_;
    Account& account_;
    std::vector<std::filesystem::path> found_;
    std::unordered_set<std::string> known_; ///< the same
};

} // namespace catoptric::scene
