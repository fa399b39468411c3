#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace catoptric::scene {

/// Scenes of more triangles are not tested: each ray meets every triangle.
inline constexpr std::size_t kMostTested = std::size_t{1} << 17;

/// Returns a camera inside the scene at rest, if the scene is a closed room that `outside` does not
/// show. Closed: nearly every ray from the centre of the bounds meets a surface. Not shown: what
/// `outside` sees are the backs of surfaces, or every mirror and lamp is hidden from it while some
/// of them can be seen from the centre. The eye is one of eight places around the centre: the
/// freest, and the one that shows most of the mirrors and lamps. It looks at the centre, and its
/// vertical field of view is 60 degrees.
std::optional<Camera> inside_camera(const Scene& scene, const Camera& outside);

} // namespace catoptric::scene
