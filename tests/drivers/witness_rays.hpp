#pragma once

#include "render/geometry.hpp"
#include "scene/built_in.hpp"
#include "support/kernel.hpp"
#include "support/kernel_shapes.hpp"

#include <string>
#include <vector>

namespace test {

/// A set of triangles, and rays to trace through them.
struct WitnessRayBatch {
    std::string name;
    std::vector<bvh::Triangle> triangles;
    std::vector<DeviceRay> rays;
    bool inside = false;  ///< rays start strictly inside a closed mesh, so that none may miss
    bool grazing = false; ///< rays lie nearly in the planes of triangles
};

/// Returns the triangles of the built-in scene as the ray tracer stores them, in scene units.
inline std::vector<bvh::Triangle> list_built_in_triangles() {
    const scene::Scene scene = scene::make_cornell();
    const render::FrameGeometry geometry = render::make_geometry(scene::scene_at(scene, 0),
                                                                 render::make_scene_units(scene));
    std::vector<bvh::Triangle> result;
    const auto corner = [&](std::size_t i) {
        return geometry.vertices[geometry.indices[i]].position;
    };
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3)
        result.push_back({corner(i), corner(i + 1), corner(i + 2)});
    return result;
}

/// Returns rays with random origins in the bounding box of the triangles and random directions.
inline std::vector<DeviceRay> make_rays_in_bounds(const std::vector<bvh::Triangle>& triangles,
                                                  std::size_t count, RandomNumbers& numbers) {
    vec3 lo(std::numeric_limits<float>::infinity()), hi = -lo;
    for (const bvh::Triangle& t : triangles)
        for (const vec3& corner : {t.a, t.b, t.c})
            lo = glm::min(lo, corner), hi = glm::max(hi, corner);
    std::vector<DeviceRay> rays(count);
    for (DeviceRay& ray : rays) {
        ray.origin = (lo + hi) / 2.0f + (hi - lo) / 2.0f * numbers.random_point_in_cube();
        ray.direction = numbers.random_unit_direction();
    }
    return rays;
}

/// Returns a random corner of a triangle, or a random point on an edge.
inline vec3 random_point_on_edge(const std::vector<bvh::Triangle>& triangles,
                                 RandomNumbers& numbers) {
    const bvh::Triangle& t = triangles[numbers.random_integer_below(triangles.size())];
    const std::size_t first = numbers.random_integer_below(3);
    const vec3 from = std::array{t.a, t.b, t.c}[first], to = std::array{t.b, t.c, t.a}[first];
    return numbers.random_word() % 4 == 0 ? from
                                          : from + numbers.random_unit_fraction() * (to - from);
}

/// Returns the rays, each turned towards a corner of a triangle or a point on an edge.
inline std::vector<DeviceRay> turn_rays_to_edges(std::vector<DeviceRay> rays,
                                                 const std::vector<bvh::Triangle>& triangles,
                                                 RandomNumbers& numbers) {
    for (DeviceRay& ray : rays) {
        ray.direction = random_point_on_edge(triangles, numbers) - ray.origin;
        if (numbers.random_word() % 2 == 0) ray.direction = glm::normalize(ray.direction);
    }
    return rays;
}

/// Returns rays through random points of triangles, at angles of 10^-1 to 10^-7 to the triangle's
/// plane.
inline std::vector<DeviceRay> make_grazing_rays(const std::vector<bvh::Triangle>& triangles,
                                                std::size_t count, RandomNumbers& numbers) {
    std::vector<DeviceRay> rays(count);
    for (DeviceRay& ray : rays) {
        const bvh::Triangle& t = triangles[numbers.random_integer_below(triangles.size())];
        const vec3 w = numbers.random_barycentric_weights(), along = glm::normalize(t.b - t.a),
                   normal = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
        const float turn = numbers.random_number_between(-3.1416f, 3.1416f);
        const vec3 flat = std::cos(turn) * along + std::sin(turn) * glm::cross(normal, along);
        ray.direction = glm::normalize(flat + numbers.random_log_uniform_number(-7, -1) * normal);
        ray.origin = w.x * t.a + w.y * t.b + w.z * t.c -
                     numbers.random_number_between(0.01f, 1) * glm::distance(t.a, t.b) *
                         ray.direction;
    }
    return rays;
}

/// Returns rays with origins strictly inside a closed mesh and random directions.
inline std::vector<DeviceRay> make_rays_inside_mesh(const ClosedMesh& closed, double scale,
                                                    dvec3 offset, std::size_t count,
                                                    RandomNumbers& numbers) {
    std::vector<DeviceRay> rays(count);
    for (DeviceRay& ray : rays) {
        ray.origin = random_point_inside(closed, scale, offset, numbers);
        ray.direction = numbers.random_unit_direction();
    }
    return rays;
}

} // namespace test
