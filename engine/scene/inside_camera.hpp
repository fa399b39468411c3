#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace catoptric::scene {

/// Largest number of triangles of a scene that is tested for a closed room. Each ray is tested
/// against every triangle, so larger scenes would take too long.
inline constexpr std::size_t kMaxTestedTriangles = std::size_t{1} << 17;

struct InsideCamera {
    Camera camera;
    /// Nearly every direction from the eye meets the front of a surface that is no glass. If not,
    /// the scene is closed but hardly a room: a can, a drinking glass, or a room whose walls face
    /// out.
    bool is_in_room = false;
};

/// Returns a camera inside the scene at rest, if the scene is a closed room that `outside` does not
/// show. The room is closed if nearly every ray from the centre of the bounds meets a surface.
/// `outside` does not show the room in two cases:
///   - Nearly everything that it sees is the back of a surface.
///   - Every mirror and lamp is hidden from it, although some can be seen from the centre.
/// The eye is the best of eight places around the centre, or of places closer to it if none of them
/// is in the room: much free space around it, and a view of most mirrors and lamps. It looks at the
/// centre with a vertical field of view of 60 degrees.
std::optional<InsideCamera> find_inside_camera(const Scene& scene, const Camera& outside);

} // namespace catoptric::scene
