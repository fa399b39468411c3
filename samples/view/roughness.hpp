#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// Functions for the roughness of mirrors that the user sets in the window.
namespace catoptric::view {

/// Roughness by number of the mirror, from 1.
using MirrorRoughness = std::map<std::uint32_t, float>;

/// Gives each mirror a material of its own, because the window changes mirrors one by one, and
/// marks the objects as mirrors. All pictures stay the same.
void separate_materials(scene::Scene& scene);
/// Returns the roughness of a mirror, from 0 (sharp), if the window can change it: its material
/// must be one that `--mirror NAME=R,roughness=A` makes. A material with textures is not.
std::optional<float> find_editable_roughness(const scene::Scene& scene, std::uint32_t mirror);
/// The mirror must be editable.
scene::Material change_roughness(const scene::Scene& scene, std::uint32_t mirror, float roughness);
/// Returns the words of `--mirror` options that give the mirrors of another scene the same
/// roughness as the mirrors of `scene`.
std::vector<std::string> roughness_words(const scene::Scene& scene,
                                         const MirrorRoughness& roughness);

} // namespace catoptric::view
