#pragma once

#include "../core/export.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace catoptric::scene {

/// Something in a scene file that is left out or approximated, or that was added to the scene. Ids
/// are fixed words: "normal-texture", "rough-metal", "added-camera" ...
struct UnsupportedFeature {
    std::string id;
    std::uint64_t count = 0;
    std::string first; ///< first place, printable
    /// Indices into Scene::materials of the materials with this feature; reports find its pixels by
    /// them. Empty if the feature does not concern materials.
    std::vector<std::size_t> materials;
};

/// Adds `count` to the feature of this id, or adds a new feature.
CATOPTRIC_API void add_unsupported(std::vector<UnsupportedFeature>& unsupported,
                                   const std::string& id, const std::string& first,
                                   std::uint64_t count = 1);
CATOPTRIC_API void add_unsupported_material(std::vector<UnsupportedFeature>& unsupported,
                                            const std::string& id, const std::string& first,
                                            std::size_t material);

} // namespace catoptric::scene
