#pragma once

#include "import/file_options.hpp"
#include "import/load.hpp"
#include "scene/scene_overrides.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// SCENE.catoptric.json: overrides that a user writes into a file beside a scene.
///   {"mirrors": ["PATTERN=REFLECTANCE", ...], "lights": ["PATTERN", ...],
///    "mirror_max_roughness": 0.6, "dielectric_mirrors": false,
///    "multiple_scattering": "none|turquin", "glass_shadow": "none|tint", "environment":
///    "FILE|studio|none", "environment_scale": 1, "environment_rotate": 0, "ambient": 0.05,
///    "exposure": "auto" | STOPS, "camera": "C", "up": "y|z", "animation": "NAME|none"}
/// Each key takes the same value as the option of that name. A picture lies below the scene's
/// folder or --root.
namespace catoptric::scene {

std::filesystem::path scene_file_path(const std::filesystem::path& scene);

struct SceneFile {
    std::filesystem::path path;
    SceneOverrides overrides;                 ///< with the real path of the environment's picture
    std::vector<std::filesystem::path> files; ///< real paths: this file and those it names
};

/// Reads the scene file of `scene`. Returns nothing if the file does not exist. Throws `bad_data`,
/// naming file and key, for a value that is not allowed.
std::optional<SceneFile> read_scene_file(const std::filesystem::path& scene,
                                         const FileOptions& options);

/// Reads "KEY=VALUE", with a key of a scene file and its value. A text needs no quotes, and one
/// text is a list of one. Throws `usage`.
SceneOverrides read_override(const std::string& text);

/// Returns the text that `read_scene_file` reads as these overrides. Throws `usage` for a picture
/// that does not lie below the scene's folder.
std::string scene_file_text(const SceneOverrides& overrides, const std::filesystem::path& scene);

} // namespace catoptric::scene
