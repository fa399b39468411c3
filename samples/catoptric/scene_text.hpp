#pragma once

#include "json.hpp"

#include <string>

namespace catoptric::cli {

/// What `info SCENE` prints: what the scene is, a line a material, mirror, light, camera and gap.
std::string scene_text(const SceneWords& words);

} // namespace catoptric::cli
