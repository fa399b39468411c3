#pragma once

#include "scene/scene.hpp"

#include <algorithm>

namespace catoptric::render {

/// Scene units: world positions minus an origin, times a power of two. With that scale, the largest
/// extent of the scene's core (scene/scene_core.hpp) is about 1. The conversion uses double, before
/// any position becomes a float. Therefore neither the scale of a scene nor its distance from the
/// world's origin reaches the device. Distant objects do not reduce the precision of the core.
struct SceneUnits {
    dvec3 origin{0};
    double scale = 1;   ///< scene units per world unit, a power of two
    Bounds<float> core; ///< scene units; objects may lie outside

    bool operator==(const SceneUnits&) const = default;
    dvec3 to_scene(const dvec3& world) const { return (world - origin) * scale; }
    vec3 to_scene_point(const dvec3& world) const { return vec3(to_scene(world)); }
    float to_scene_length(double world) const { return static_cast<float>(world * scale); }
};

/// Returns whether the box is smaller than require::kSmallObjectRatio of its distance from the
/// origin; world units. The distance is that of its farthest corner. Empty boxes and points are not
/// small.
bool is_small_for_distance(const Bounds<double>& box, const dvec3& origin);

/// Returns the scene units of a scene at rest. All frames use the same units, so that motion does
/// not change them.
///
/// The origin is the centre of the core. If mirrors in the core are small from there, but none is
/// small from the centre of their bounds, that centre becomes the origin. Reflections are seen
/// close to these mirrors and need a float's precision. Mirrors that no common origin suits do not
/// move it, nor do mirrors outside the core, which would take precision from everything else. Small
/// objects have an object space instead (object_space.hpp).
SceneUnits make_scene_units(const scene::Scene& scene);

/// Throws `exhausted` with the object's name if a corner of `box` (scene units) is farther away
/// than scene::kMaxSceneRadius.
void check_object_distance(const Bounds<float>& box, const std::string& object);

inline double largest_component(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

} // namespace catoptric::render
