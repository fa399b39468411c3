#pragma once

#include "scene/scene.hpp"

#include <string>
#include <vector>

// The table of built-in scenes, which need no file, and functions that build the scenes for which
// C++ code asks.
namespace catoptric::scene {

/// Scene that needs no file. The .cpp file that builds the scene also registers it; nothing else
/// lists it.
struct BuiltInScene {
    std::string name;
    std::string summary; ///< one line for `list`
    Scene (*make)();     ///< Scene::name equals `name`
    int order = 1000;    ///< place in lists; equal orders are sorted by name
};
/// A variable of this type at namespace scope adds the scene to the table while the program starts.
struct RegisteredBuiltInScene {
    explicit RegisteredBuiltInScene(BuiltInScene scene);
};
/// Sorted by `order`, then by name.
const std::vector<BuiltInScene>& built_in_scenes();

/// Builds the Cornell box with four mirror balls (contract: "The built-in scene").
Scene make_cornell();
/// Builds the Cornell box with four mirror balls and a white front wall that camera rays ignore.
Scene make_closed_cornell();
/// Builds the Cornell box with metal balls of roughness .05, .15, .3 and .5 instead of mirrors.
Scene make_rough_cornell();
/// Builds a room with six balls and six slanted slabs of metal, of roughness .05 to .6.
Scene make_roughness_room();
/// Builds a closed room with one flat mirror.
Scene make_flat_room();
/// Builds a furnished room: textures, shared meshes, a wall mirror, a smooth floor, two lamps, a
/// spot.
Scene make_furnished_room();
/// Builds a hall with sixteen mirrors through which the camera walks.
Scene make_gallery();
/// Builds an open court under a sky, with a hollow dish.
Scene make_courtyard();

} // namespace catoptric::scene
