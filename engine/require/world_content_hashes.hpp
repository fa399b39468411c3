#pragma once

#include "core/content_hash.hpp"
#include "scene/light.hpp"
#include "scene/scene.hpp"

/// Content hashes of parts of a scene. Equal hashes stand for parts that look the same.
namespace catoptric::require {

std::uint64_t hash_mesh(const scene::Mesh& mesh);
/// Returns the content hash of all materials, including the texels of their images. O(texels).
std::uint64_t hash_materials(const std::vector<scene::Material>& materials);
/// Null is a black environment.
std::uint64_t hash_environment(const scene::Environment* environment);
std::uint64_t hash_point_light(const scene::PointLight& light);

} // namespace catoptric::require
