#pragma once

#include "scene/scene.hpp"

#include <string>

namespace catoptric::scene {

/// Returns the 64-bit FNV-1a hash of names, geometry, materials, motion, cameras, lights and
/// environment, as 16 hex digits. The scene's own name, its warnings and its files do not count: a
/// copied file has the same hash.
std::string hash_scene(const Scene& scene);

} // namespace catoptric::scene
