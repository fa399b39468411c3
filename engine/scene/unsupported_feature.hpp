#pragma once

#include "../core/export.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace catoptric::scene {

/// What a file says that is not shown as it says, or what was added to it. Ids are fixed words:
/// "normal-texture", "rough-metal", "added-camera" ...
struct UnsupportedFeature {
    std::string id;
    std::uint64_t count = 0;
    std::string first; ///< where, printable
    /// Indices into Scene::materials of those that have it, by which its pixels are told; empty
    /// where it is not of materials.
    std::vector<std::size_t> materials;
};

/// Adds to the scene's gap of this id, or a new one.
CATOPTRIC_API void add_unsupported(std::vector<UnsupportedFeature>& unsupported,
                                   const std::string& id, const std::string& first,
                                   std::uint64_t count = 1);
CATOPTRIC_API void add_unsupported_material(std::vector<UnsupportedFeature>& unsupported,
                                            const std::string& id, const std::string& first,
                                            std::size_t material);

} // namespace catoptric::scene
