#pragma once

#include "../scene/scene.hpp"

#include <filesystem>
#include <string>

/// Reads and writes scene files.
namespace catoptric::scene {

struct LoadOptions {
    /// Second folder below which the files named by a scene may lie. The first is the real folder
    /// of the scene. Empty: no second folder.
    std::filesystem::path root;
    /// Name of the animation that moves the nodes of a glTF file, or "none". Empty: the first
    /// animation.
    std::string animation;
};

/// Loads a built-in scene by name, or a .glb, .gltf or .obj file, and finds its mirrors. Throws
/// `Failure::usage`, with the nearest built-in name, for a word that is neither. Throws
/// `missing_input` for a file that does not exist. Throws `bad_data`, naming file and place, for
/// content that cannot be read, exceeds the budget, or lies outside the allowed folders. The
/// scene's warnings list what was left out or repaired, with a count for each kind.
CATOPTRIC_API Scene load(const std::string& name_or_path, const LoadOptions& options = {});

/// Writes a scene as .glb, or as .obj with an .mtl file beside it. The same scene gives the same
/// bytes. Throws `cannot_create` or `io`. An existing file is replaced only by a complete one.
CATOPTRIC_API void save_glb(const Scene& scene, const std::filesystem::path& path);
CATOPTRIC_API void save_obj(const Scene& scene, const std::filesystem::path& path);

} // namespace catoptric::scene
