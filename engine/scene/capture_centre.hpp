#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace catoptric::scene {

/// Returns the other objects that may lie in an object, at least in part: their bounds overlap its
/// bounds, and are not around them as those of a room. `bounds`: of each object, in any common
/// space.
std::vector<std::size_t> objects_within(std::span<const Bounds<double>> bounds, std::size_t object);

/// Returns the place in the world from which a mirror's surroundings are captured: the centre of
/// its bounds. If a closed object `within` the mirror encloses it, the capture would show nothing
/// but that object from inside. Then it is the middle between these objects and the bounds, on the
/// axis or diagonal of the bounds where the objects end first. If all such places are enclosed, it
/// is the centre. Costs O(n) in the triangles of objects whose bounds contain a tried place.
dvec3 capture_centre(const Scene& scene, std::size_t mirror, std::span<const std::size_t> within);

/// Returns capture_centre of each mirror, in the order of scene::mirrors. Costs O(n) in vertices.
std::vector<dvec3> capture_centres(const Scene& scene);

} // namespace catoptric::scene
