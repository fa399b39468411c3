#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// Makes `still`, a copy of the scene or what this made of one before, what `at` gives for the
/// instant, without copying a mesh or a material. A time that is not finite is `Failure::usage`.
void pose(Scene& still, const Scene& scene, double seconds);

/// Throws `usage` for a time that is not a finite number of seconds.
void check_time(double seconds);

} // namespace catoptric::scene
