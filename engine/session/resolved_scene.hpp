#pragma once

#include "import/file_options.hpp"
#include "import/load.hpp"
#include "scene/scene_overrides.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::session {

/// A scene with the user's overrides applied, completed if its file lacks something.
struct ResolvedScene {
    scene::Scene scene;
    /// Overrides in effect, those of `scene_file` included.
    scene::SceneOverrides overrides;
    std::optional<scene::Camera> camera; ///< camera that the user names
    /// The user asks for a drawn camera (session/seeded_camera.hpp).
    bool is_camera_seeded = false;
    /// Messages about files read and parts added, a sentence each.
    std::vector<std::string> said;
    std::optional<std::filesystem::path> scene_file; ///< SCENE.catoptric.json, if it was read
    bool is_file = false;                            ///< false: the scene is built in
};

struct ResolveOptions {
    scene::FileOptions load;
    /// Overrides of the command line; they win over those of SCENE.catoptric.json.
    scene::SceneOverrides overrides;
    bool use_scene_file = true; ///< read SCENE.catoptric.json
};

/// Loads a scene, reads SCENE.catoptric.json beside it, applies all overrides and completes the
/// scene. Keeps at most 16 lights of a scene file. A scene without a light gets the environment
/// `studio` (gap "added-studio"), unless the user says something about it. Throws as scene::load,
/// scene::read_scene_file, scene::apply_overrides and scene::find_camera do, and `bad_data`
/// for a picture that cannot be an environment.
ResolvedScene resolve_scene(const std::string& name, const ResolveOptions& options);

/// Returns the ambient light: the user's value, else 0 with an environment and .05 without.
double choose_ambient(const ResolvedScene& wanted);
/// Returns the exposure in stops that the user or else the scene sets. If neither does, returns 0
/// for scenes built in code, and nothing for scene files: session/exposure.hpp finds it then.
std::optional<double> find_exposure(const ResolvedScene& wanted);
/// Returns the user's camera, or else the scene's first. If there is none, adds a camera (gap
/// "added-camera") and reports it in `said`: scene::find_inside_camera for a closed room, else
/// scene::default_camera.
scene::Camera choose_camera(ResolvedScene& wanted, double aspect);

} // namespace catoptric::session
