#include "require/reach.hpp"

#include "require/wall.hpp"
#include "scene/light.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::require {

dvec3 find_flat_normal(const scene::Mesh& mesh) {
    const double least = std::cos(kMaxNormalDeviation / 2);
    dvec3 normal(0);
    const auto agrees = [&](const dvec3& other) {
        if (normal == dvec3(0)) normal = other;
        return dot(normal, other) >= least;
    };
    for (const uvec3& t : mesh.triangles) {
        const dvec3& a = mesh.positions[t.x];
        const dvec3 facet = scene::normalized_or_zero(
            cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
        if (facet == dvec3(0)) continue;
        for (int i = 0; i < 3; ++i)
            if (const dvec3 own(mesh.normals[t[i]]);
                !agrees(own) || std::abs(dot(facet, normal)) < least)
                return dvec3(0);
    }
    return normal;
}

FaceBits needed_faces(const Bounds<double>& mirror, const dvec3& normal, double margin,
                      std::span<const Bounds<double>> viewers) {
    const auto [low, high] = project_box(normal, mirror);
    bool front = true, back = true;
    for (const Bounds<double>& viewer : viewers) {
        const auto [viewer_low, viewer_high] = project_box(normal, viewer);
        // A viewer in the mirror's plane sees no part of the mirror's surface.
        if (viewer_low > low - margin && viewer_high < high + margin) continue;
        front = front && viewer_low > high;
        back = back && viewer_high < low;
    }
    if (front == back) return kAllFaces; // no viewer, or viewers on both sides
    return faces_in_front(front ? normal : -normal, 2 * kMaxNormalDeviation);
}

bool may_light_reach(const scene::PointLight& light, const Bounds<double>& box, double margin) {
    if (light.directional) return true;
    const dvec3 nearest = glm::clamp(light.position, box.lo, box.hi);
    if (!(length(nearest - light.position) <= light.range + margin)) return false;
    return light.normal == dvec3(0) ||
           project_box(light.normal, box)[1] - dot(light.normal, light.position) > -margin;
}

} // namespace catoptric::require
