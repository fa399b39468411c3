#pragma once

#include "json.hpp"

#include <string>

namespace catoptric::cli {

/// Returns the output of `info SCENE`: a summary, then a line per material, mirror, light, camera
/// and unsupported feature.
std::string scene_text(const SceneWords& words);

} // namespace catoptric::cli
