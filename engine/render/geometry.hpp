#pragma once

#include "render/space.hpp"
#include "shared.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace catoptric::render {

/// The triangles of one object in the shared buffers.
struct DrawRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    Bounds<float> bounds; ///< scene units
    bool mirror = false;
    bool casts_shadow = true; ///< a light's own mesh does not: it would hide the light
    bool seen_by_camera = true;
    bool exact_sphere = false; ///< the mesh stands for one
    bool one_sided = false;    ///< not there from behind, where triangles run clockwise
};

/// All triangles of a frame in scene units; one range for each object, in the scene's order.
struct Geometry {
    std::vector<shared::Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<DrawRange> ranges;
    Bounds<float> core; ///< where most of it is (Space::core)
};
Geometry make_geometry(const scene::Scene& now, const Space& space);

/// Distance from a point to the nearest triangle, scene units; objects where `skip(range)` are left
/// out; infinity when nothing is left. Brute force over all triangles.
template <typename Skip>
float nearest_distance(const Geometry& geometry, vec3 point, Skip&& skip);

/// Squared distance from p to the triangle (Ericson, Real-Time Collision Detection, 5.1.5).
float squared_distance(vec3 p, vec3 a, vec3 b, vec3 c);

template <typename Skip>
float nearest_distance(const Geometry& geometry, vec3 point, Skip&& skip) {
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < geometry.ranges.size(); ++i) {
        const DrawRange& range = geometry.ranges[i];
        if (skip(i, range)) continue;
        for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count;
             k += 3) {
            const auto corner = [&](std::uint32_t j) {
                return geometry.vertices[geometry.indices[k + j]].position;
            };
            nearest = std::min(nearest, squared_distance(point, corner(0), corner(1), corner(2)));
        }
    }
    return std::sqrt(nearest);
}

} // namespace catoptric::render
