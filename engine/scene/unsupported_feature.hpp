#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// Functions that note what a loader leaves out.
namespace catoptric::scene {

/// Returns the place of an item of a file: "nodes[3] 'lamp'", or "nodes[3]" without a name.
std::string item_label(std::string_view list, std::size_t index, const std::string& name = {});

/// Adds `count` to the feature of this id, or adds a new feature.
void add_unsupported(std::vector<UnsupportedFeature>& unsupported, const std::string& id,
                     const std::string& first, std::uint64_t count = 1);
void add_unsupported_material(std::vector<UnsupportedFeature>& unsupported, const std::string& id,
                              const std::string& first, std::size_t material);

} // namespace catoptric::scene
