#pragma once

#include "core/content_hash.hpp"
#include "scene/scene.hpp"

/// Numbers that stand for parts of a scene: what is seen of them is the same while they are.
namespace catoptric::require {

std::uint64_t content_hash_of(const scene::Mesh& mesh);
/// Of all materials, texels of their images with them. O(texels).
std::uint64_t content_hash_of(const std::vector<scene::Material>& materials);
/// None: black.
std::uint64_t content_hash_of(const scene::Environment* environment);
std::uint64_t content_hash_of(const scene::PointLight& light);

} // namespace catoptric::require
