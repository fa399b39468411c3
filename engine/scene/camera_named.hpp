#pragma once

#include "scene/said_by.hpp"
#include "scene/scene.hpp"

#include <string>

namespace catoptric::scene {

/// The camera that a user named: a name, an index from 0, or in numbers "EX,EY,EZ:TX,TY,TZ:FOV"
/// (eye, target, vertical degrees), "EX,EY,EZ:TX,TY,TZ:h=HEIGHT" (orthographic, so many world units
/// high). Throws with the scene's own names.
Camera camera_named(const std::string& text, const Scene& scene,
                    const SaidBy& by = {.where = "--camera"});

/// The same camera in numbers, to be typed; up is +y.
std::string camera_text(const Camera& camera);

} // namespace catoptric::scene
