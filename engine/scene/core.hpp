#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// The bounds of where a scene is at rest, world units: of everything, unless single things lie so
/// far outside (a stray triangle, a sky dome, a ground plane to the horizon) that units made for
/// them would serve nothing else. Each object counts the same, however many triangles it has: from
/// the half of the corners that lie nearest to their median the core grows as long as the next ones
/// are no more than eight times as far from there; what is farther than eight times that again is
/// left out. Looks at no more than some 60,000 corners. Empty for a scene without triangles.
Bounds<double> core_bounds(const Scene& scene);

/// In sizes of the core, how far out things can be rendered: the square of a distance must stay a
/// float.
inline constexpr double kFarthestReach = 1e18;

/// Removes objects that reach farther from the core than that, and returns their names.
std::vector<std::string> leave_out_unreachable(Scene& scene);

} // namespace catoptric::scene
