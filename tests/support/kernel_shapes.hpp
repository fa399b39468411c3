#pragma once

#include "bvh/bvh.hpp"
#include "scene/build.hpp"
#include "support/numbers.hpp"
#include "support/scenes.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

/// Meshes for tests of ray tracing, and random starts of rays inside the meshes.
namespace test {

/// A closed mesh, and the region strictly inside from which rays may start: all cubes of half edge
/// `reach` around points of the core. The core is the mesh's centre or, for a torus, a circle about
/// the z axis.
struct ClosedMesh {
    scene::Mesh mesh;
    double core_radius;
    double reach; ///< half edge of a cube around a point of the core
};
constexpr double kMinDistanceInsideMesh = 0.12; ///< least distance of these cubes from the mesh

/// Returns a torus of 64 x 32 quadrilaterals. Its circle has radius 1, its tube radius 0.4.
/// Neighbouring triangles share their corners.
inline ClosedMesh make_closed_torus() {
    constexpr std::uint32_t kTorusRings = 64, kTorusSides = 32;
    scene::Mesh mesh{.name = "torus"};
    for (std::uint32_t ring = 0; ring < kTorusRings; ++ring)
        for (std::uint32_t side = 0; side < kTorusSides; ++side) {
            const double around = 2 * std::numbers::pi * ring / kTorusRings,
                         about = 2 * std::numbers::pi * side / kTorusSides;
            const double out = 1 + 0.4 * std::cos(about);
            mesh.positions.push_back(
                {out * std::cos(around), out * std::sin(around), 0.4 * std::sin(about)});
            const auto corner = [&](std::uint32_t i, std::uint32_t k) {
                return (ring + i) % kTorusRings * kTorusSides + (side + k) % kTorusSides;
            };
            mesh.triangles.push_back({corner(0, 0), corner(1, 0), corner(1, 1)});
            mesh.triangles.push_back({corner(0, 0), corner(1, 1), corner(0, 1)});
        }
    return {std::move(mesh), 1, 0.15};
}

/// Returns a closed box of twelve triangles whose coordinates are no round numbers. `stretch` makes
/// the box longer along z.
inline ClosedMesh make_closed_box(std::string name, double stretch) {
    scene::Mesh mesh{.name = std::move(name)};
    for (int face = 0; face < 6; ++face) {
        const scene::Mesh side = make_box_wall(face, {-0.91, -0.63, -1.17 * stretch},
                                               {0.87, 0.71, 1.03 * stretch});
        const uvec3 first(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.insert(mesh.positions.end(), side.positions.begin(), side.positions.end());
        for (const uvec3& triangle : side.triangles) mesh.triangles.push_back(triangle + first);
    }
    return {std::move(mesh), 0, 0.5};
}

inline ClosedMesh make_closed_ball() { return {scene::ball("ball", 5), 0, 0.5}; }

/// Returns the mesh times `scale` plus `offset`, rounded to float. Returns nothing if rounding
/// leaves a triangle without area.
inline std::optional<std::vector<bvh::Triangle>> make_placed_triangles(const scene::Mesh& mesh,
                                                                       double scale, dvec3 offset) {
    std::vector<bvh::Triangle> result;
    for (const uvec3& t : mesh.triangles) {
        const auto corner = [&](std::uint32_t i) {
            return vec3(mesh.positions[i] * scale + offset);
        };
        const bvh::Triangle triangle{corner(t.x), corner(t.y), corner(t.z)};
        const dvec3 a(triangle.a), b(triangle.b), c(triangle.c);
        if (glm::cross(b - a, c - a) == dvec3(0)) return {};
        result.push_back(triangle);
    }
    return result;
}

/// Returns whether float precision suffices for a mesh times `scale` plus `offset`: rounding moves
/// points by less than the distance between the starts of rays and the mesh.
inline bool is_float_precise_enough(double scale, dvec3 offset) {
    const double largest = 2 * scale + glm::length(offset);
    return std::sqrt(3.0) * std::ldexp(largest, -23) < kMinDistanceInsideMesh * scale;
}

/// Returns a random start of a ray inside the placed mesh, rounded to float. The start is strictly
/// inside if is_float_precise_enough is true.
inline vec3 random_point_inside(const ClosedMesh& closed, double scale, dvec3 offset,
                                RandomNumbers& numbers) {
    dvec3 core(0);
    if (closed.core_radius > 0) {
        const double around = 2 * std::numbers::pi *
                              static_cast<double>(numbers.random_unit_fraction());
        core = closed.core_radius * dvec3(std::cos(around), std::sin(around), 0);
    }
    return vec3((core + closed.reach * dvec3(numbers.random_point_in_cube())) * scale + offset);
}

} // namespace test
