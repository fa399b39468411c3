#pragma once

#include "render/space.hpp"
#include "shared.h"

#include <cstdint>
#include <vector>

namespace catoptric::render {

/// The triangles of one object in the shared buffers.
struct DrawRange {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
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

/// Puts an object's triangles where they are now; nothing else of it may have changed since
/// `make_geometry`. Throws as check_reach does.
void move_object(Geometry& geometry, const scene::Scene& now, const Space& space,
                 std::size_t object);

/// Squared distance from p to the triangle (Ericson, Real-Time Collision Detection, 5.1.5).
float squared_distance(vec3 p, vec3 a, vec3 b, vec3 c);

} // namespace catoptric::render
