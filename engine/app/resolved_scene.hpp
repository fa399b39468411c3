#pragma once

#include "scene/load.hpp"
#include "scene/scene_overrides.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::app {

/// A scene as its user wants it, completed where its file says too little.
struct ResolvedScene {
    scene::Scene scene;
    scene::SceneOverrides overrides;     ///< in effect, the scene file's among them
    std::optional<scene::Camera> camera; ///< the wished one
    bool is_camera_seeded = false;       ///< wished is one that is drawn (app/seeded_camera.hpp)
    std::vector<std::string> said;       ///< what was read beside it or added, a sentence each
    std::optional<std::filesystem::path> scene_file; ///< that was read
    bool is_file = false;                            ///< else built in
};

struct ResolveOptions {
    scene::LoadOptions load;
    scene::SceneOverrides overrides; ///< of the command line; they win
    bool use_scene_file = true;      ///< SCENE.catoptric.json
};

/// Loads a scene, reads the file beside it, applies what is wished and completes what a file leaves
/// open: at most 16 lights; without a light and a word about it the environment `studio` (gap
/// "added-studio"). Throws as scene::load, scene::read_scene_file, scene::apply and
/// scene::camera_named do, and
/// `bad_data` for a picture that cannot be an environment.
ResolvedScene resolve_scene(const std::string& name, const ResolveOptions& options);

/// Light that each surface gets anyway: as wished; else none in an environment, .05 elsewhere.
double ambient_of(const ResolvedScene& wanted);
/// As wished, or as the scene says; none: to be found (app/exposure.hpp), as files want it. Scenes
/// built in code: 0.
std::optional<double> exposure_of(const ResolvedScene& wanted);
/// The wished camera, or the scene's first; else one is added (scene::inside_camera of a closed
/// room, else scene::default_camera; gap "added-camera") and said.
scene::Camera camera_of(ResolvedScene& wanted, double aspect);

} // namespace catoptric::app
