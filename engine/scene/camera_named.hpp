#pragma once

#include "scene/scene.hpp"
#include "scene/setting_origin.hpp"

#include <string>

namespace catoptric::scene {

/// Returns the camera that a user named. `text` is a camera's name, an index from 0, or numbers.
/// "EX,EY,EZ:TX,TY,TZ:FOV" is a perspective camera: eye, target and vertical field of view in
/// degrees. "EX,EY,EZ:TX,TY,TZ:h=HEIGHT" is an orthographic camera whose picture is HEIGHT world
/// units high. For any other text throws `by.failure`, with the names of the scene's cameras.
Camera find_camera(const std::string& text, const Scene& scene,
                   const SettingOrigin& by = {.where = "--camera"});

/// Returns the camera as numbers that `find_camera` reads. The text holds no up vector: the
/// camera read from it has +y up, or +z if it looks straight up or down.
std::string format_camera(const Camera& camera);

} // namespace catoptric::scene
