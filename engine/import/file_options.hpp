#pragma once

#include "import/budget.hpp"
#include "import/load.hpp"
#include "scene/setting_origin.hpp"

#include <filesystem>
#include <string>

// Functions that load scenes with limits on memory and work.
namespace catoptric::scene {

/// Options of `load` with the limits on a file's memory and work.
struct FileOptions {
    /// Second folder below which the files named by a scene may lie. The first is the real folder
    /// of the scene. Empty: no second folder.
    std::filesystem::path root;
    /// Name of the animation that moves the nodes of a glTF file, or "none". Empty: the first
    /// animation.
    std::string animation;
    SettingOrigin animation_by{.where = "--animation"};
    LoadBudget budget;
};

/// Throws as `load` does for a word that is no scene, or for a file that does not exist. Reads
/// nothing.
void check_exists(const std::string& name_or_path);

/// Loads as `load` does.
Scene load_file(const std::string& name_or_path, const FileOptions& options);

/// Reads a glTF or an OBJ file. Throws as `load`.
Scene load_gltf(const std::filesystem::path& path, const FileOptions& options = {});
Scene load_obj(const std::filesystem::path& path, const FileOptions& options = {});

} // namespace catoptric::scene
