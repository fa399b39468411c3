#pragma once

#include "scene/load.hpp"
#include "scene/scene_overrides.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// SCENE.catoptric.json: what a user says of a scene, beside it.
///   {"mirrors": ["PATTERN=REFLECTANCE", ...], "lights": ["PATTERN", ...],
///    "mirror_max_roughness": 0.1, "dielectric_mirrors": false, "environment": "FILE|studio|none",
///    "environment_scale": 1, "environment_rotate": 0, "ambient": 0.05, "exposure": "auto" | STOPS,
///    "camera": "C", "up": "y|z", "animation": "NAME|none"}
/// Each as the option of that name takes it; a picture lies below the scene's folder, or --root.
namespace catoptric::scene {

std::filesystem::path scene_file_of(const std::filesystem::path& scene);

struct SceneFile {
    std::filesystem::path path;
    SceneOverrides overrides;                 ///< a picture by its real path
    std::vector<std::filesystem::path> files; ///< real paths: its own, and of what it names
};

/// None where there is no such file. Throws `bad_data` naming file and key for what cannot be.
std::optional<SceneFile> read_scene_file(const std::filesystem::path& scene,
                                         const LoadOptions& options);

/// What `read_scene_file` reads as these wishes. Throws `usage` for a picture that does not lie
/// below the scene's folder.
std::string scene_file_text(const SceneOverrides& overrides, const std::filesystem::path& scene);

} // namespace catoptric::scene
