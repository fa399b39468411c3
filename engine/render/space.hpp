#pragma once

#include "scene/scene.hpp"

namespace catoptric::render {

/// Scene units: world positions minus the scene's centre, times a power of two that makes its
/// largest extent about 1. Done in double before anything becomes a float, so that neither the
/// scale of a scene nor its distance from the origin reaches the device.
struct Space {
    dvec3 centre_world{0};
    double scale = 1; ///< scene units per world unit, a power of two

    vec3 point(const dvec3& world) const { return vec3((world - centre_world) * scale); }
    float length(double world) const { return static_cast<float>(world * scale); }
};

/// Of the scene at rest; the same for all its frames, so that motion does not move the units.
Space space_of(const scene::Scene& scene);

} // namespace catoptric::render
