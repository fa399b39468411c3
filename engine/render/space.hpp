#pragma once

#include "scene/scene.hpp"

#include <algorithm>

namespace catoptric::render {

/// Scene units: world positions minus an origin, times a power of two that makes the largest extent
/// of the scene's core (scene/core.hpp) about 1. Done in double before anything becomes a float, so
/// that neither the scale of a scene nor its distance from the world's origin reaches the device,
/// and nothing far outside costs what is looked at its precision.
struct Space {
    dvec3 origin_world{0};
    double scale = 1;   ///< scene units per world unit, a power of two
    Bounds<float> core; ///< scene units; things may lie outside

    bool operator==(const Space&) const = default;
    dvec3 place(const dvec3& world) const { return (world - origin_world) * scale; }
    vec3 point(const dvec3& world) const { return vec3(place(world)); }
    float length(double world) const { return static_cast<float>(world * scale); }
};

/// Smaller than this part of its distance from the origin, a thing loses half of a float's digits.
inline constexpr double kSmallPart = 0x1p-12;

/// Whether it is, its distance that of its farthest corner; world units. Not of what is a point or
/// nothing.
bool is_small(const Bounds<double>& box, const dvec3& origin);

/// Of the scene at rest; the same for all its frames, so that motion does not move the units. The
/// origin is the core's centre. Where mirrors in the core are small from there but not from the
/// centre of their bounds, it is that: reflections are looked at next to them, with a float's
/// digits. Mirrors that no one place suits, and those outside the core, which would take the digits
/// from all else, do not move it: what is small keeps a space of its own (own_space.hpp).
Space space_of(const scene::Scene& scene);

/// Throws `exhausted` naming the object where a corner of `box` (scene units) is farther away than
/// scene::kFarthestReach.
void check_reach(const Bounds<float>& box, const std::string& object);

inline double largest_component(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

} // namespace catoptric::render
