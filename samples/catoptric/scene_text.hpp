#pragma once

#include "json.hpp"

#include <string>

namespace catoptric::cli {

/// Returns the output of `info SCENE`: a summary, then a line per material, mirror, light, camera
/// and unsupported feature.
std::string format_scene_info(const SceneInfoFacts& words);

} // namespace catoptric::cli
