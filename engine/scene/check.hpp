#pragma once

#include "core/error.hpp"
#include "scene/scene.hpp"

#include <string>

namespace catoptric::scene {

/// Throws `bad_data`, as check_scene does, unless the material can stand at this index of the
/// scene.
void check_material(const Scene& scene, std::size_t index, const Material& material);

/// Throws `failure` with `where` unless the camera's members are finite, and it has a direction, an
/// upward direction beside it, and a field of view or a height.
void check_camera(const Camera& camera, const std::string& where, Failure failure);

} // namespace catoptric::scene
