#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace catoptric::app {

/// A camera drawn at random that sees a mirror of the scene at this instant: at least a hundredth
/// of a square picture is the front of mirrors. Same scene, instant and seed, same camera, on every
/// machine.
///
/// Of one mirror, each as likely: target in its bounds; eye in any direction that is not nearly
/// upright, at a distance from 1.5 times the radius of those bounds (half their diagonal) to the
/// diagonal of the scene's, all orders of magnitude alike; vertical field of view 25 to 60 degrees.
/// Drawn again until a mirror is seen. Places are rounded to about a thousandth of the scene's
/// extent, so that the camera can be typed: its name is its text, EX,EY,EZ:TX,TY,TZ:FOV. A scene
/// without mirrors is taken as if all its objects were mirrors. Throws `Failure::usage` where 1000
/// draws see none.
scene::Camera seeded_camera(const scene::Scene& scene, double seconds, std::uint64_t seed);
/// One for each seed; the scene is made ready for rays once.
std::vector<scene::Camera> seeded_cameras(const scene::Scene& scene, double seconds,
                                          std::span<const std::uint64_t> seeds);

} // namespace catoptric::app
