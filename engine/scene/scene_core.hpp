#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// Returns the bounds of the core of a scene at rest, in world units. The core is the whole scene,
/// unless single objects lie very far outside. Examples are a stray triangle, a sky dome, or a
/// ground plane to the horizon. Scene units that fit such objects would not suit the rest. The core
/// starts as the half of the corners that lie nearest to their median. It grows as long as the next
/// corner is at most eight times as far from the median. Corners farther than eight times the last
/// distance are left out. Each object has the same weight, however many triangles it has. Looks at
/// about 60,000 corners at most; with more than 20,000 objects, at one triangle of each. Empty for
/// a scene without triangles.
Bounds<double> core_bounds(const Scene& scene);

/// Largest distance from the core of the scene (core_bounds) at which objects can be rendered, in
/// sizes of the core. The square of a distance must stay a finite float.
inline constexpr double kMaxSceneRadius = 1e18;

/// Removes the objects that reach farther from the core than kMaxSceneRadius. Returns their names.
std::vector<std::string> remove_distant_objects(Scene& scene);

} // namespace catoptric::scene
