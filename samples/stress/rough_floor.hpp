#pragma once

#include "stress/bench.hpp"

#include <array>

/// A floor of strips that differ in roughness, below an environment that is white everywhere.
namespace catoptric::stress {

/// Roughness of the strips, from left to right.
constexpr std::array kFloorStripRoughness{.05, .1, .2, .3, .5, .7, .85, 1.};

/// Returns the floor, seen from far away at `degrees` from its normal. It fills the picture, and
/// every pixel sees it at this angle. `material` gives all of the material except the roughness.
/// Each strip is a mirror of its own if `is_mirror` is set.
scene::Scene make_rough_floor(const scene::Material& material, double degrees, bool is_mirror);

scene::Material make_white_metal();
/// Reflects .04 of the light head-on, and all at grazing angle.
scene::Material make_white_plastic();

/// Returns the mean radiance of each strip in a picture of the floor that `technique` renders
/// without ambient light. NaN if a pixel of the strip is not finite.
std::array<double, kFloorStripRoughness.size()>
measure_strips(Bench& bench, const scene::Scene& floor, const std::string& technique);

} // namespace catoptric::stress
