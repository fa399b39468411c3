#pragma once

#include "scene/build.hpp"

// Shapes of the built-in scenes.
namespace catoptric::scene {

/// Height of a part of a built-in scene above its support, in metres. If two surfaces lie in one
/// plane, chance decides which of them a picture shows.
inline constexpr double kSupportGap = .001;

/// Returns the wall of the box [lo, hi] in direction `face`, facing in. The directions are +X -X +Y
/// -Y +Z -Z, as the faces of a cube map.
Mesh make_box_wall(int face, dvec3 lo, dvec3 hi);

/// Materials of the side walls of a papered room.
struct RoomPaints {
    std::size_t orange = 0, blue = 0;
};
/// Adds the walls of the room [lo, hi]: orange towards +X, blue towards -X, a checkered floor of
/// two sRGB colours, wallpaper on the wall `papered` (as in make_box_wall), white elsewhere.
RoomPaints add_papered_room(Scene& scene, dvec3 lo, dvec3 hi, uvec3 dark_floor, uvec3 light_floor,
                            int papered);

} // namespace catoptric::scene
