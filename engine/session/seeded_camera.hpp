#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace catoptric::session {

/// Draws a random camera that sees a mirror of the scene at this instant: at least a hundredth of a
/// square picture shows the front of mirrors. The same scene, instant and seed give the same camera
/// on every machine.
///
/// The camera aims at one mirror, each equally likely. The target lies in the mirror's bounds. The
/// eye lies in any direction that is not nearly upright. Its distance is at least 1.5 times the
/// radius of those bounds (half their diagonal) and at most the diagonal of the scene's bounds. Its
/// logarithm is uniform. The vertical field of view is 25 to 60 degrees. Cameras are drawn until
/// one sees a mirror. Positions are rounded to about a thousandth of the scene's extent, so that
/// the camera can be typed. The camera's name is its text, EX,EY,EZ:TX,TY,TZ:FOV. In a scene
/// without mirrors all objects count as mirrors. Throws `Failure::usage` if 1000 draws see no
/// mirror.
scene::Camera make_seeded_camera(const scene::Scene& scene, double seconds, std::uint64_t seed);
/// Prepares the scene for rays only once.
std::vector<scene::Camera> make_seeded_cameras(const scene::Scene& scene, double seconds,
                                               std::span<const std::uint64_t> seeds);

} // namespace catoptric::session
